#include "core/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace faba {
namespace {

template <class T>
T select(std::span<T> values, std::size_t k) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  const auto at = values.begin() + std::ptrdiff_t(k);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class T>
T select_low(std::span<T> values, double p) {
  return values.empty() ? std::numeric_limits<T>::quiet_NaN()
                        : select(values, std::size_t(p * double(values.size() - 1)));
}

template <class T>
T select_nearest(std::span<T> values, double p) {
  return values.empty() ? std::numeric_limits<T>::quiet_NaN()
                        : select(values, std::size_t(std::lround(p * double(values.size() - 1))));
}

template <class T>
double interpolate(std::span<const T> values, double p) {
  if (!(p >= 0 && p <= 1))
    throw Error(Errc::internal, "quantile", fmt::format("p is {}; it must be between 0 and 1", p));
  if (values.empty()) return kNaN;
  std::vector<T> v(values.begin(), values.end());
  if (std::any_of(v.begin(), v.end(), [](T x) { return std::isnan(x); })) return kNaN;
  const double h = p * double(v.size() - 1);
  const auto k = std::size_t(h);
  const auto at = v.begin() + std::ptrdiff_t(k);
  std::nth_element(v.begin(), at, v.end());
  const double below = double(*at);
  if (h == double(k)) return below;
  const double above = double(*std::min_element(at + 1, v.end()));
  // Between two equal infinities the difference is NaN.
  return above == below ? below : below + (h - double(k)) * (above - below);
}

}  // namespace

double quantile(std::span<const double> values, double p) { return interpolate(values, p); }
double quantile(std::span<const float> values, double p) { return interpolate(values, p); }

double median(std::span<const double> values) { return interpolate(values, 0.5); }
double median(std::span<const float> values) { return interpolate(values, 0.5); }

RobustSpread<double> robust_spread(std::span<const double> values) {
  RobustSpread<double> s;
  s.median = median(values);
  std::vector<double> deviation(values.begin(), values.end());
  for (double& v : deviation) v = std::fabs(v - s.median);
  s.sd = kMadToSd * median(deviation);
  return s;
}

double order_statistic(std::span<double> values, std::size_t k) { return select(values, k); }
float order_statistic(std::span<float> values, std::size_t k) { return select(values, k); }

double quantile_low(std::span<double> values, double p) { return select_low(values, p); }
float quantile_low(std::span<float> values, double p) { return select_low(values, p); }

double quantile_nearest(std::span<double> values, double p) { return select_nearest(values, p); }
float quantile_nearest(std::span<float> values, double p) { return select_nearest(values, p); }

double median_low(std::span<double> values) {
  return select(values, values.empty() ? 0 : (values.size() - 1) / 2);
}
float median_low(std::span<float> values) {
  return select(values, values.empty() ? 0 : (values.size() - 1) / 2);
}

double median_high(std::span<double> values) { return select(values, values.size() / 2); }
float median_high(std::span<float> values) { return select(values, values.size() / 2); }

RobustSpread<float> robust_spread_low(std::span<float> values) {
  RobustSpread<float> s;
  s.median = median_low(values);
  for (float& v : values) v = std::fabs(v - s.median);
  s.sd = float(kMadToSd) * median_low(values);
  return s;
}

}  // namespace faba
