#include "study/stats/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/error.h"

namespace faba {
namespace {

/// The continued fraction of the incomplete beta function by Lentz's method.
double beta_fraction(double x, double a, double b) {
  constexpr double kTiny = 1e-300;
  const auto away = [](double v) { return std::fabs(v) < kTiny ? kTiny : v; };
  double c = 1, d = 1 / away(1 - (a + b) * x / (a + 1)), f = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away(1 + even * d);
    c = away(1 + even / c);
    f *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away(1 + odd * d);
    c = away(1 + odd / c);
    f *= c * d;
    if (std::fabs(c * d - 1) < 1e-16) break;
  }
  return f;
}

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) out[order[k]] = double(i + j + 1) / 2;
    i = j;
  }
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = double(a.size());
  const double ma = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mb = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
    ab += (a[i] - ma) * (b[i] - mb);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

std::array<double, 2> interval(double value, double se, int freedom) {
  const double reach = student_t_quantile(0.975, freedom) * se;
  return {value - reach, value + reach};
}

}  // namespace

double incomplete_beta(double x, double a, double b) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;
}

double student_t_cdf(double t, double freedom) {
  // The tail itself, so that it stays exact where it is small.
  const double tail = 0.5 * incomplete_beta(freedom / (freedom + t * t), freedom / 2, 0.5);
  return t > 0 ? 1 - tail : tail;
}

double student_t_quantile(double p, double freedom) {
  if (!(p > 0 && p < 1 && freedom > 0))
    throw Error(Errc::internal, "student_t_quantile", "needs 0 < p < 1 and degrees of freedom");
  if (p > 0.5) return -student_t_quantile(1 - p, freedom);
  if (p == 0.5) return 0;
  double low = -1, high = 0;
  while (student_t_cdf(low, freedom) > p) low *= 2;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (student_t_cdf(middle, freedom) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::array<double, 2> LineFit::intercept_ci95() const { return interval(intercept, se_intercept, freedom); }
std::array<double, 2> LineFit::slope_ci95() const { return interval(slope, se_slope, freedom); }

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  if (n < 3 || y.size() != n) throw Error(Errc::internal, "fit_line", "needs three points or more");
  const double count = double(n);
  const double mx = std::accumulate(x.begin(), x.end(), 0.0) / count;
  const double my = std::accumulate(y.begin(), y.end(), 0.0) / count;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
  }
  if (!(xx > 0)) throw Error(Errc::internal, "fit_line", "needs two different x");
  LineFit f;
  f.slope = xy / xx;
  f.intercept = my - f.slope * mx;
  f.freedom = int(n) - 2;
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double off = y[i] - f.intercept - f.slope * x[i];
    squares += off * off;
  }
  f.sd = std::sqrt(squares / f.freedom);
  f.se_slope = f.sd / std::sqrt(xx);
  f.se_intercept = f.sd * std::sqrt(1 / count + mx * mx / xx);
  return f;
}

double spearman(std::span<const double> x, std::span<const double> y) {
  return correlation(ranks(x), ranks(y));
}

double spearman_p(std::span<const double> x, std::span<const double> y) {
  const std::vector<double> rx = ranks(x), ry = ranks(y);
  const double rho = std::fabs(correlation(rx, ry));
  const std::size_t n = rx.size();
  if (n > 8) {
    if (rho >= 1) return 0;
    const double t = rho * std::sqrt((double(n) - 2) / (1 - rho * rho));
    return 2 * student_t_cdf(-t, double(n) - 2);
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double all = 0, as_far = 0;
  do {
    std::vector<double> shuffled(n);
    for (std::size_t i = 0; i < n; ++i) shuffled[i] = ry[order[i]];
    ++all;
    if (std::fabs(correlation(rx, shuffled)) > rho - 1e-9) ++as_far;
  } while (std::next_permutation(order.begin(), order.end()));
  return as_far / all;
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double sample_sd(std::span<const double> values) {
  if (values.size() < 2) return 0;
  const double n = double(values.size()), mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / (n - 1));
}

}  // namespace faba
