#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// A value measured on a sample that had been in air for some time.
struct ExposureValue {
  double exposure_s = 0, value = 0;
  std::string experiment;  ///< samples of one experiment share what is peculiar to it
};

/// A straight line against exposure.
struct ExposureLine {
  double slope = 0, intercept = 0;
  std::array<double, 2> slope_ci95{}, intercept_ci95{};
  double scatter_sd = 0;     ///< about the line, within an experiment
  double experiment_sd = 0;  ///< of the experiments' own shifts
  int values = 0, experiments = 0;
};

/// Ordinary least squares over all values, as the thesis has it: its interval takes values of one experiment
/// for independent. Empty with fewer than three values or one exposure only.
std::optional<ExposureLine> pooled_line(std::span<const ExposureValue> values);

/// Line with a shift of its own for every experiment (random intercepts, restricted maximum likelihood), with
/// intervals that hold where late values scatter more than early ones, too: theory A16. The slope has values
/// - experiments - 1 degrees of freedom, the intercept experiments - 1 (values - 2 where the experiments do
/// not differ). With one experiment it is the pooled line. Empty with fewer values than that takes.
std::optional<ExposureLine> mixed_line(std::span<const ExposureValue> values);

/// Whether a sample responded.
struct ExposureResponse {
  double exposure_s = 0;
  bool responds = false;
};
/// The exposure beyond which samples no longer respond: the cut that puts the fewest on the wrong side,
/// half-way between the exposures next to it. Empty when all respond or none does.
struct Cutoff {
  double cutoff_s = 0;
  std::array<double, 2> between_s{};  ///< the exposures next to it
  int wrong = 0;                      ///< samples on the wrong side
};
std::optional<Cutoff> response_cutoff(std::span<const ExposureResponse> samples);

}  // namespace faba
