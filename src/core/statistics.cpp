#include "core/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::size_t kMany = 1 << 13;  // values, from which on a sample is taken first
constexpr std::size_t kSample = 1 << 10;

// x_k of many values, in one pass without branches that the processor cannot predict: bounds that contain x_k
// almost certainly are taken from a sample, and only the values between them are partitioned. Empty if x_k is
// not between the bounds, or if an eighth of the values is.
template <class T>
std::optional<T> select_by_sample(std::span<const T> values, std::size_t k) {
  const std::size_t n = values.size();
  std::vector<T> sample(kSample);
  for (std::size_t i = 0; i < kSample; ++i) sample[i] = values[i * n / kSample];
  std::sort(sample.begin(), sample.end());
  // The rank of x_k in the sample has a standard deviation of at most sqrt(kSample) / 2 = 16.
  constexpr std::size_t kMargin = 48;
  const std::size_t rank = k * kSample / n;
  const T low = sample[rank < kMargin ? 0 : rank - kMargin];
  const T high = sample[std::min(kSample - 1, rank + kMargin)];
  constexpr std::size_t kBlock = 1024;
  std::vector<T> between(n / 8 + kBlock);
  std::size_t below = 0, kept = 0;
  for (std::size_t first = 0; first < n; first += kBlock) {
    if (kept > n / 8) return {};
    for (const T v : values.subspan(first, std::min(kBlock, n - first))) {
      between[kept] = v;
      kept += std::size_t(v >= low) & std::size_t(v <= high);
      below += std::size_t(v < low);
    }
  }
  if (k < below || k >= below + kept) return {};
  const auto at = between.begin() + std::ptrdiff_t(k - below);
  std::nth_element(between.begin(), at, between.begin() + std::ptrdiff_t(kept));
  return *at;
}

template <class T>
T select(std::span<T> values, std::size_t k) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  if (values.size() >= kMany)
    if (const auto found = select_by_sample(std::span<const T>(values), k)) return *found;
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
