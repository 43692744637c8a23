#pragma once
#include <span>
#include <string>

namespace faba {

/// A Gaussian on an offset, amplitude * exp(-(t - peak_s)^2 / (2 sigma_s^2)) + offset, fitted to a series by
/// least squares (Levenberg-Marquardt; theory A16).
struct GaussianFit {
  double amplitude = 0, peak_s = 0, sigma_s = 0, offset = 0;
  /// Standard errors, from the residuals and their correlation between neighbouring values.
  double se_amplitude = 0, se_peak_s = 0, se_sigma_s = 0, se_offset = 0;
  double scatter = 0;  ///< standard deviation of the residuals
  /// Whether the peak is accepted: its amplitude is at least three times the scatter and significant, and it
  /// is inside the series and not wider than it.
  bool good = false;
  std::string reason = {};  ///< reason why the peak is not accepted; empty when good
};

/// `t_s` is increasing, `values` have the same length and are not negative. No fit with fewer than six values
/// or equal values.
GaussianFit fit_gaussian(std::span<const double> t_s, std::span<const double> values);

}  // namespace faba
