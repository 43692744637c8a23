#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "study/steering/controller_study.h"
#include "study/sweep/sweep.h"

namespace faba {

/// A parameter of a controller that is tuned.
struct TunedParameter {
  std::string key, unit;
  double low = 0, high = 0;       ///< range of the search, in `unit`
  std::optional<double> given{};  ///< value in the scenario; none: not set there
};

/// Input of tune(): parameters of a scenario's controller, a metric to minimise, and the seeds.
struct TuningStudy {
  Document scene;  ///< with the controller that is tuned
  std::string controller;
  std::vector<TunedParameter> parameters;
  std::string metric;       ///< key in metric_list()
  int evaluations = 40;     ///< parameter sets at most
  int seeds = 10;           ///< trials of each parameter set
  int held_out_seeds = 20;  ///< trials of the comparison at the end
  std::uint64_t first_seed = 100001, first_held_out = 1;
  std::shared_ptr<const Parts> parts = nullptr;  ///< null: those of the program
  std::vector<std::string> notes = {};           ///< of the scenario
};

/// Wishes of the user; empty: the defaults that new_tuning() chooses.
struct TuningChoice {
  std::string controller, metric;
  std::vector<std::string> ranges;  ///< "gain=0.1..2", "lead=20 ms..300 ms"
};
/// The study of a scenario: its controller with the parameters that have a range for tuning
/// (FieldInfo::tuned), or those of `ranges`. `controller`: replaces the scenario's, with default values. The
/// default metric is the steady-state error of one setpoint, and the IAE of several. Throws Error(usage).
TuningStudy new_tuning(const Document& scene, const TuningChoice& choice);

/// A parameter set with its result.
struct TunedPoint {
  std::vector<double> value;  ///< of the parameters, in their units; empty: the controller as given
  MeanOverSeeds metric;       ///< `n` below the number of trials: undefined in some of them
  bool refused = false;       ///< by the controller or another rule of the scenario
};

struct Tuning {
  TuningStudy study;
  std::vector<TunedPoint> evaluated;  ///< in the order of the search; the first is the controller as given
  std::size_t best = 0;               ///< index of the smallest mean
  TunedPoint held_out_given, held_out_best;
  MeanOverSeeds held_out_difference;  ///< best minus given, paired by the seeds
  Json scene;                         ///< resolved scenario with the best parameters
};

std::string study_hash(const TuningStudy& study);
/// Searches: a low-discrepancy design over the ranges (logarithmic), then a local search (SBPLX of NLopt)
/// from its best point; then compares the best with the given controller on other seeds. Every parameter set
/// is tried with the same seeds. Empty when tasks of other processes are missing. Throws the errors of
/// sweep().
std::optional<Tuning> tune(const TuningStudy& study, ResultStore& results, const SweepOptions& options);
/// The tasks of one round of the search from its description; `study` must outlive them.
Round tuning_round(const TuningStudy& study, const std::string& description,
                   const std::function<bool()>& stop);

}  // namespace faba
