#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "study/calibrate/calibration_study.h"

namespace faba {

/// An experiment with known parameters, measured.
struct TrueExperiment {
  std::size_t model = 0;      ///< candidate
  std::vector<double> truth;  ///< values of its free parameters
  int samples = 0;            ///< of the parameters, with those of experiments that could not be measured
  std::vector<ResponseVideo> videos;
};

/// Seed of an experiment for a purpose.
enum class ExperimentSeed : std::uint64_t { truth, simulation, identification, ranks };
std::uint64_t experiment_seed(const CalibrationStudy& study, std::uint64_t experiment,
                              ExperimentSeed purpose);

/// Parameters of a candidate sampled from its prior, as fractions of their ranges.
Eigen::VectorXd sampled_prior(const Candidate& c, StudyRandom& random);

/// Checks the scenarios of all kinds of experiments. Throws Error(usage), for example for unknown paths.
void check_kinds(const CalibrationStudy& study, const std::vector<ResponseVideo>& design);

/// Simulates an experiment of the study with parameters from the prior, and measures it. Parameters that are
/// not compatible, and experiments without cells in view, are sampled again. `tick` is called after each
/// frame that is read. Throws Error(input) when no experiment can be measured.
TrueExperiment true_experiment(const CalibrationStudy& study, const std::vector<ResponseVideo>& design,
                               std::uint64_t experiment, const std::function<void()>& tick);

}  // namespace faba
