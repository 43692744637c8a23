#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"
#include "study/sweep/variant.h"

namespace faba {

/// Input of compare_controllers(): every controller is combined with every model and every camera delay, each
/// with the same seeds.
struct ControllerStudy {
  std::string title;
  Document scene;  ///< scenario of all trials
  std::vector<Variant> controllers, models;
  std::vector<int> delays;  ///< frames; empty: that of the scene
  int seeds = 20;           ///< trials of each combination, with consecutive seeds from `first_seed`
  std::uint64_t first_seed = 1;
  std::shared_ptr<const Parts> parts = nullptr;  ///< of the scenarios; null: those of the program
  std::string ranked_by = "steady_rms_px";       ///< metric of the best controller
  /// Controllers with which all others are compared: the best of them, with the same model and delay.
  std::vector<std::string> baseline = {};
  /// Polygons that the swarm must not enter, image coordinates; controllers with obstacles know them.
  std::vector<std::vector<Vec2>> keep_out_px = {};
  std::string label = {};  ///< distinguishes studies with their results in one store
};
/// Reads a study file: `scene`, `seeds`, `first_seed`, `delays`, [[controller]], [[model]] (see Variant).
/// Throws Error(usage).
ControllerStudy read_controller_study(const std::filesystem::path& file);

/// A mean over seeds with its 95 % confidence interval (Student's t).
struct MeanOverSeeds {
  double mean = 0, sd = 0;
  std::array<double, 2> ci95{};
  int n = 0;  ///< trials in which the quantity was defined
};

/// Of the finite values.
MeanOverSeeds mean_over_seeds(const std::vector<double>& values);

/// Results of a controller over the seeds, with one model and one delay.
struct Combination {
  std::string controller, model;
  int delay = 0;                                 ///< frames
  std::map<std::string, MeanOverSeeds> metrics;  ///< by key; metrics that are defined in at least one trial
  int settled = 0, trials = 0;
  std::array<double, 2> settled_ci95{};  ///< of the fraction of trials that settle (Wilson)
  /// Mean over the seeds and standard deviation, for each frame.
  std::vector<double> t_s, distance_px, distance_sd_px, rms_radius_px, rms_radius_sd_px;
  /// `ranked_by` minus that of the best controller with the same model and delay: mean of the paired
  /// differences over the seeds, with interval. Empty for the best controller.
  std::optional<MeanOverSeeds> excess_over_best;
  /// Comparison with the best controller of the baseline; empty for those of the baseline.
  std::string baseline;
  std::map<std::string, MeanOverSeeds> minus_baseline;  ///< paired differences, by metric
};

struct ControllerComparison {
  ControllerStudy study;
  std::vector<Combination> combinations;  ///< by model, delay and controller, in the order of the study
  std::vector<std::string> notes = {};    ///< notes on doubtful settings of the scene
  double um_per_px = 1;                   ///< of the first combination
};

/// JSON Schema of a study file.
Json controller_study_schema();
/// Hash of everything that the result depends on.
std::string study_hash(const ControllerStudy& study);
/// Runs the trials that have no result in `results`. Checks every combination before the first trial. Empty
/// when tasks of other shards are missing. Throws Error(usage) for invalid combinations, and the errors of
/// sweep().
std::optional<ControllerComparison> compare_controllers(const ControllerStudy& study, ResultStore& results,
                                                        const SweepOptions& options);

/// The resolved scenario of the trials with the smallest mean steady-state error, of the first model and
/// delay of the study. Null if no trial has a steady-state error.
Json best_scene(const ControllerComparison& result);

/// The trials of the study as tasks; `study` must outlive them. Trials end early when `stop` is true.
Round controller_trials(const ControllerStudy& study, const std::function<bool()>& stop);
/// Names of the first values of a trial; the others are times, distances and radii at some of the frames.
std::vector<std::string> trial_value_names();

}  // namespace faba
