#pragma once
#include <cstddef>
#include <limits>
#include <span>

namespace faba {

/// NaN: an undefined figure, such as the standard error of one value.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Standard deviation of a Gaussian over its median absolute deviation, 1 / Phi^-1(3/4), to five digits.
inline constexpr double kMadToSd = 1.4826;

/// Quantile of type 7 of Hyndman & Fan (The American Statistician 50:361, 1996), the default of NumPy, R and
/// Julia: with x_0 <= ... <= x_(n-1) and h = p (n - 1) it is x_floor(h) + (h - floor(h)) (x_(floor(h)+1) -
/// x_floor(h)), linear between order statistics. NaN when there are no values or one of them is NaN. Throws
/// Error(Errc::internal) unless 0 <= p <= 1.
double quantile(std::span<const double> values, double p);
double quantile(std::span<const float> values, double p);

/// quantile(values, 0.5): the middle value, or the mean of the two middle values when n is even.
double median(std::span<const double> values);
double median(std::span<const float> values);

/// Median, and standard deviation of the Gaussian with the same median absolute deviation.
template <class T>
struct RobustSpread {
  T median = 0, sd = 0;
};

/// median(values) and kMadToSd * median(|values - median|); both NaN when there are no values or one is NaN.
RobustSpread<double> robust_spread(std::span<const double> values);

/// The functions below select one of the values and do not interpolate. They are for code that runs for each
/// pixel or frame, and for results that must be bit-identical. They may reorder `values`. None of the values
/// may be NaN: which value is returned is then unspecified. The result is NaN when there are no values.

/// Order statistic x_k, 0 <= k < n (k = 0: the minimum).
double order_statistic(std::span<double> values, std::size_t k);
float order_statistic(std::span<float> values, std::size_t k);

/// x_floor(p (n - 1)), 0 <= p <= 1: NumPy's method "lower".
double quantile_low(std::span<double> values, double p);
float quantile_low(std::span<float> values, double p);

/// x_round(p (n - 1)), 0 <= p <= 1, a half is rounded up: the order statistic nearest to the quantile.
double quantile_nearest(std::span<double> values, double p);
float quantile_nearest(std::span<float> values, double p);

/// x_floor((n - 1) / 2): the lower of the two middle values when n is even, as Python's
/// statistics.median_low.
double median_low(std::span<double> values);
float median_low(std::span<float> values);

/// x_floor(n / 2): the upper of the two middle values when n is even, as Python's statistics.median_high.
double median_high(std::span<double> values);
float median_high(std::span<float> values);

/// median_low(values) and kMadToSd * median_low(|values - median|), in single precision. On return `values`
/// holds the absolute deviations.
RobustSpread<float> robust_spread_low(std::span<float> values);

}  // namespace faba
