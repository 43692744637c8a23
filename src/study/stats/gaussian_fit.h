#pragma once
#include <span>
#include <string>

namespace faba {

/// A Gaussian on an offset, amplitude * exp(-(t - peak_s)^2 / (2 sigma_s^2)) + offset, fitted to a series by
/// least squares (Levenberg-Marquardt; theory A16).
struct GaussianFit {
  double amplitude = 0, peak_s = 0, sigma_s = 0, offset = 0;
  /// Standard errors, from the scatter about the curve with its correlation from one value to the next
  /// allowed for.
  double se_amplitude = 0, se_peak_s = 0, se_sigma_s = 0, se_offset = 0;
  double scatter = 0;  ///< standard deviation about the curve
  /// Whether there is such a peak: the amplitude is three times the scatter or more, the peak lies in the
  /// series, and is no wider than it.
  bool good = false;
  std::string why = {};  ///< what is against it; empty when good
};

/// `t_s` increasing, `values` of the same length and not negative; nor is the offset. With fewer than six
/// values, or values that are all equal, nothing is fitted.
GaussianFit fit_gaussian(std::span<const double> t_s, std::span<const double> values);

}  // namespace faba
