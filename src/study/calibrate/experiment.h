#pragma once
#include <functional>
#include <string>
#include <vector>

#include "study/calibrate/calibration_study.h"

namespace faba {

/// The estimate of one parameter of the true model, and its true value.
struct CalibratedEstimate {
  double truth = 0, mean = 0, median = 0, sd = 0, low90 = 0, high90 = 0;
  double fraction_of_range = 0;  ///< that the 90 % interval covers
  /// Probability of the posterior below the true value; uniform on 0 to 1 for a calibrated posterior.
  double rank = 0;
};

/// Result of one experiment of a calibration.
struct CalibrationRecord {
  bool failed = true;               ///< no model could be identified
  double true_model = 0, best = 0;  ///< candidates
  double evidence = 0;              ///< 0 none, 1 weak, 2 clear
  double fit_p = 0;                 ///< of the best model
  double warnings = 0;              ///< number of warnings
  double samples = 1;  ///< sampled parameters, with those of experiments that could not be measured
  double named = 0;    ///< 1 if a warning names the difference of a misspecified experiment
  /// Probability of the posterior nearer to a random reference point than the true parameters (Lemos et al.
  /// 2023); uniform on 0 to 1 for a calibrated posterior.
  double tarp = 0;
  std::vector<CalibratedEstimate> estimates;  ///< of the true model; empty if it could not be identified

  std::vector<double> values() const;
  static CalibrationRecord of(std::span<const double> values);
  static std::vector<std::string> names();  ///< of the first values
};

/// Simulates an experiment of the study and identifies it, on the calling thread. `design`: the measured
/// videos of the study. The result depends only on the study and the number of the experiment. Throws
/// Error(interrupted) when `stop` is true.
CalibrationRecord calibration_experiment(const CalibrationStudy& study,
                                         const std::vector<ResponseVideo>& design, std::uint64_t experiment,
                                         const std::function<bool()>& stop);

}  // namespace faba
