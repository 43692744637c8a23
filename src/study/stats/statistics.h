#pragma once
#include <array>
#include <span>

#include "core/statistics.h"

namespace faba {

/// A straight line y = intercept + slope * x by least squares.
struct LineFit {
  double intercept = 0, slope = 0;
  double se_intercept = 0, se_slope = 0;  ///< standard errors
  double sd = 0;                          ///< standard deviation of the residuals, n - 2 degrees of freedom
  int freedom = 0;                        ///< n - 2
  /// 95 % confidence interval, Student's t.
  std::array<double, 2> intercept_ci95() const;
  std::array<double, 2> slope_ci95() const;
};

/// Fits a line to at least three points with at least two different x. Throws Error(Errc::internal) for
/// fewer, and for spans of different lengths.
LineFit fit_line(std::span<const double> x, std::span<const double> y);

/// Spearman's rank correlation, -1..1; ties have the mean of their ranks. 0 when one side is constant.
double spearman(std::span<const double> x, std::span<const double> y);

/// Two-sided p-value of the rank correlation under random permutations of y: exact for up to 8 points, else
/// Student's t with n - 2 degrees of freedom.
double spearman_p(std::span<const double> x, std::span<const double> y);

/// Arithmetic mean of at least one value.
double mean(std::span<const double> values);

/// Standard deviation with n - 1; 0 for fewer than two values.
double sample_sd(std::span<const double> values);

}  // namespace faba
