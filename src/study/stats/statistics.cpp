#include "study/stats/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/random/distributions.h"

namespace faba {
namespace {

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
  const double half_ci = student_t_quantile(0.975, freedom) * se;
  return {value - half_ci, value + half_ci};
}

}  // namespace

std::array<double, 2> LineFit::intercept_ci95() const { return interval(intercept, se_intercept, freedom); }
std::array<double, 2> LineFit::slope_ci95() const { return interval(slope, se_slope, freedom); }

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  if (n < 3 || y.size() != n) throw Error(Errc::internal, "fit_line", "needs at least three points");
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
