#include "study/stats/gaussian_fit.h"

#include <fmt/format.h>
#include <unsupported/Eigen/LevenbergMarquardt>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/counted.h"
#include "core/statistics.h"

namespace faba {
namespace {

// Threshold of the F statistic of the fit over a constant. For 3 and many degrees of freedom F exceeds it
// with a probability of 1e-6; a peak has about a hundred possible positions and widths.
constexpr double kLeastF = 10;

/// Residuals in units of the largest value, over times in units of the duration of the series. The last
/// parameter is the root of the offset: activity is not negative, and a negative offset would allow
/// arbitrarily broad peaks.
struct Peak : Eigen::DenseFunctor<double> {
  const std::vector<double>&t, &y;
  Peak(const std::vector<double>& times, const std::vector<double>& values)
      : DenseFunctor(4, int(values.size())), t(times), y(values) {}
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double z = (t[i] - x[1]) / x[2];
      r[Eigen::Index(i)] = x[0] * std::exp(-z * z / 2) + x[3] * x[3] - y[i];
    }
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& j) const {
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double z = (t[i] - x[1]) / x[2], e = std::exp(-z * z / 2);
      j.row(Eigen::Index(i)) << e, x[0] * e * z / x[2], x[0] * e * z * z / x[2], 2 * x[3];
    }
    return 0;
  }
};

// Mean over five values, so that the initial maximum is not a single outlier.
std::vector<double> smoothed(const std::vector<double>& y) {
  std::vector<double> out(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const std::size_t a = i < 2 ? 0 : i - 2, b = std::min(y.size(), i + 3);
    for (std::size_t k = a; k < b; ++k) out[i] += y[k] / double(b - a);
  }
  return out;
}

Eigen::VectorXd start(const std::vector<double>& t, const std::vector<double>& y) {
  const std::vector<double> s = smoothed(y);
  const auto top = std::size_t(std::max_element(s.begin(), s.end()) - s.begin());
  std::vector<double> work = s;
  const double floor = quantile_low(work, 0.1), half = (s[top] + floor) / 2;
  std::size_t left = top, right = top;
  while (left > 0 && s[left] > half) --left;
  while (right + 1 < s.size() && s[right] > half) ++right;
  Eigen::VectorXd x(4);
  x << s[top] - floor, t[top], std::max((t[right] - t[left]) / 2.355, 1.5 / double(t.size())),
      std::sqrt(std::max(floor, 1e-4));
  return x;
}

// Number of values per independent value, from the correlation of neighbouring residuals.
double correlated_values(const Eigen::VectorXd& r) {
  const Eigen::Index n = r.size();
  const double rho =
      std::clamp(r.head(n - 1).dot(r.tail(n - 1)) / std::max(r.squaredNorm(), 1e-300), 0.0, 0.95);
  return (1 + rho) / (1 - rho);
}

// The reason why a fit is not accepted as a peak, or an empty string. `x` has unit duration and height, `sd`
// is the standard deviation of its residuals.
std::string weakness(const GaussianFit& fit, const Eigen::VectorXd& x, double sd, double f,
                     std::size_t values) {
  if (!(x[0] > 3 * sd)) return "the peak is at most three standard deviations of the residuals high";
  if (!(fit.amplitude > 2 * fit.se_amplitude)) return "the standard error of its height is above 50 %";
  if (!(f > kLeastF)) return "the fit is not significantly better than a constant";
  if (!(x[1] > 0 && x[1] < 1)) return "the peak is outside the video";
  if (!(x[2] * double(values - 1) > 1)) return "the peak is narrower than two values";
  if (!(x[2] < 1)) return "the peak is wider than the duration of the video";
  return {};
}

}  // namespace

GaussianFit fit_gaussian(std::span<const double> t_s, std::span<const double> values) {
  GaussianFit fit;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.size() < 6 || !(*high > *low) || !(*high > 0)) {
    fit.reason = values.size() < 6
                     ? fmt::format("{} of frames, at least 6 are needed", counted(values.size(), "pair"))
                     : "all values are equal";
    if (!values.empty()) fit.offset = values.front();
    return fit;
  }
  const double begin = t_s.front(), length = t_s.back() - begin, range = *high;
  std::vector<double> t, y;
  for (std::size_t i = 0; i < values.size(); ++i) {
    t.push_back((t_s[i] - begin) / length);
    y.push_back(values[i] / range);
  }

  Peak peak(t, y);
  Eigen::VectorXd x = start(t, y);
  Eigen::LevenbergMarquardt<Peak> lm(peak);
  lm.minimize(x);
  x[2] = std::fabs(x[2]);
  Eigen::VectorXd r(Eigen::Index(y.size()));
  Eigen::MatrixXd j(Eigen::Index(y.size()), 4);
  peak(x, r);
  peak.df(x, j);
  const double variance = r.squaredNorm() / double(y.size() - 4);
  const Eigen::MatrixXd covariance =
      (j.transpose() * j).completeOrthogonalDecomposition().pseudoInverse() * variance * correlated_values(r);
  const auto se = [&](int i) { return std::sqrt(std::max(covariance(i, i), 0.0)); };
  fit.amplitude = x[0] * range;
  fit.peak_s = begin + x[1] * length;
  fit.sigma_s = x[2] * length;
  fit.offset = x[3] * x[3] * range;
  fit.se_amplitude = se(0) * range;
  fit.se_peak_s = se(1) * length;
  fit.se_sigma_s = se(2) * length;
  fit.se_offset = 2 * std::fabs(x[3]) * se(3) * range;
  fit.scatter = std::sqrt(variance) * range;
  double constant = 0, mean = 0;
  for (const double v : y) mean += v / double(y.size());
  for (const double v : y) constant += (v - mean) * (v - mean);
  const double free_values = double(y.size()) / correlated_values(r) - 4;
  const double f = free_values > 1 ? (constant / std::max(r.squaredNorm(), 1e-300) - 1) / 3 * free_values : 0;
  if (!std::isfinite(x.sum())) {
    fit = {};
    fit.reason = "the fit diverged";
    return fit;
  }
  fit.reason = weakness(fit, x, std::sqrt(variance), f, y.size());
  fit.good = fit.reason.empty();
  return fit;
}

}  // namespace faba
