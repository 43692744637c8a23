#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study/calibrate/calibration_study.h"
#include "study/calibrate/experiment.h"
#include "study/calibrate/rank_statistics.h"
#include "study/quality/quality.h"
#include "study/sweep/sweep.h"

namespace faba {

/// A number of experiments, of a total, with its 95 % interval of the fraction (Clopper and Pearson).
struct ExperimentCount {
  int count = 0, of = 0;
  std::array<double, 2> ci95{};
};

/// Calibration of one parameter of a true model.
struct ParameterCalibration {
  FreeParameter parameter;
  std::vector<CalibratedEstimate> estimates = {};
  std::vector<Coverage> coverage = {};  ///< at kCoverageLevels
  RankHistogram ranks = {};
  /// Posterior mean minus truth in units of the posterior's standard deviation: mean over the experiments
  /// with standard error, and standard deviation, which is 1 for a calibrated normal posterior. The last two
  /// are NaN for one experiment.
  double bias = 0, bias_se = 0, spread = 0;
  /// Median over the experiments of median / truth - 1, and of its absolute value; NaN if the truth can be 0.
  double relative_bias = 0, relative_error = 0;
  double fraction_of_range = 0;  ///< median of the fraction of the prior range that a 90 % interval covers
};

/// Calibration of the experiments of one true model, whose cells are as it describes.
struct ModelCalibration {
  std::string name;
  int experiments = 0;
  std::vector<ParameterCalibration> parameters = {};
  RankCurve tarp = {};
};

/// Selection of models in the experiments of one kind.
struct SelectionCalibration {
  std::string kind;
  bool misspecified = false;
  int experiments = 0, failed = 0, sampled_again = 0;
  /// These and the next three are empty with one candidate: there is no selection.
  ExperimentCount best_is_true = {}, clear = {}, weak = {};
  /// Clear evidence for another model than the true one.
  ExperimentCount wrong_clear = {};
  /// A wrong answer with confidence: clear evidence for another model, or clear evidence and the 90 %
  /// interval of the first parameter of the true model does not contain the truth.
  ExperimentCount false_clear = {};
  /// Those of false_clear in which no warning names the difference.
  ExperimentCount false_clear_unnamed = {};
  ExperimentCount named = {}, warned = {};
  ExperimentCount inside = {};  ///< 90 % interval of the first parameter contains the truth
};

struct StudyCalibration {
  CalibrationStudy study;
  std::vector<ModelCalibration> models;  ///< true models of the well-specified experiments
  std::vector<SelectionCalibration> kinds;
  std::vector<CalibrationRecord> records;  ///< of all experiments, in their order
};

/// Measures the videos of the study, computes the experiments that have no result in `results`, and analyses
/// them. Empty when other shards have experiments left. `reading` is called after each frame that is read.
/// Throws the errors of identify() and sweep().
std::optional<StudyCalibration> calibrate(const CalibrationStudy& study, ResultStore& results,
                                          const SweepOptions& options, const std::function<void()>& reading);

/// The experiments as tasks, for a process that does not read the videos: their measurements are in the
/// folder `measured`. `study` must outlive the round.
Round calibration_round(const CalibrationStudy& study, const std::filesystem::path& measured,
                        const std::function<bool()>& stop);

/// The parameters whose intervals are not calibrated, too few experiments, and experiments that failed.
std::vector<Warning> calibration_warnings(const StudyCalibration& c);

}  // namespace faba
