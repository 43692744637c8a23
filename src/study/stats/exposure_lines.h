#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// A value measured on a sample after an air exposure time.
struct ExposureValue {
  double exposure_s = 0, value = 0;
  std::string experiment;  ///< samples of one experiment have a common random shift
};

/// A straight line of a value against air exposure time.
struct ExposureLine {
  double slope = 0, intercept = 0;
  std::array<double, 2> slope_ci95{}, intercept_ci95{};
  double scatter_sd = 0;     ///< standard deviation about the line within an experiment
  double experiment_sd = 0;  ///< standard deviation of the shifts between experiments
  int values = 0, experiments = 0;
};

/// Ordinary least squares over all values, as in the thesis: its interval assumes that values of one
/// experiment are independent. Empty with fewer than three values or one exposure only.
std::optional<ExposureLine> pooled_line(std::span<const ExposureValue> values);

/// Line with a random intercept for each experiment (mixed model, restricted maximum likelihood). The
/// intervals are valid for heteroscedastic scatter, too: theory A16. The slope has values - experiments - 1
/// degrees of freedom, the intercept experiments - 1 (both values - 2 where the experiments do not differ).
/// With one experiment it is the pooled line. Empty with too few values.
std::optional<ExposureLine> mixed_line(std::span<const ExposureValue> values);

/// Whether a sample responded.
struct ExposureResponse {
  double exposure_s = 0;
  bool responds = false;
};
/// The air exposure time beyond which samples no longer respond: the cut with the fewest misclassified
/// samples, midway between its neighbouring exposures. Empty when all samples respond or none.
struct Cutoff {
  double cutoff_s = 0;
  std::array<double, 2> between_s{};  ///< the neighbouring exposures
  int wrong = 0;                      ///< number of misclassified samples
};
std::optional<Cutoff> response_cutoff(std::span<const ExposureResponse> samples);

}  // namespace faba
