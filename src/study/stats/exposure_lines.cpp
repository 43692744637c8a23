#include "study/stats/exposure_lines.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/random/distributions.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

/// Generalised least squares for one ratio of variances (between experiments over within).
struct Trial {
  Eigen::Vector2d beta;         ///< intercept, slope
  Eigen::Matrix2d information;  ///< X' V^-1 X, V in units of the variance within experiments
  double variance = 0;          ///< within experiments
  double criterion = 0;         ///< -2 log restricted likelihood, without a constant
};

struct Sums {
  double n = 0;
  Eigen::Vector2d sx = Eigen::Vector2d::Zero();  ///< sums over rows (1, x)
  Eigen::Matrix2d xx = Eigen::Matrix2d::Zero();
  Eigen::Vector2d xy = Eigen::Vector2d::Zero();
  double sy = 0, yy = 0;
};

Trial solve(const std::vector<Sums>& groups, double ratio, double n) {
  Trial t;
  t.information.setZero();
  Eigen::Vector2d xy = Eigen::Vector2d::Zero();
  double yy = 0, log_det = 0;
  for (const Sums& g : groups) {
    const double shared = ratio / (1 + g.n * ratio);  // V^-1 = 1 - shared 11'
    t.information += g.xx - shared * g.sx * g.sx.transpose();
    xy += g.xy - shared * g.sx * g.sy;
    yy += g.yy - shared * g.sy * g.sy;
    log_det += std::log1p(g.n * ratio);
  }
  t.beta = t.information.ldlt().solve(xy);
  const double rss = std::max(yy - t.beta.dot(xy), 0.0);
  t.variance = rss / (n - 2);
  t.criterion = (n - 2) * std::log(std::max(rss, 1e-300)) + log_det + std::log(t.information.determinant());
  return t;
}

// Means of exposures and values, subtracted before summation to reduce cancellation.
struct Centre {
  double x = 0, y = 0;
};

std::vector<Sums> groups_of(std::span<const ExposureValue> values, Centre c) {
  std::map<std::string, Sums> by_name;
  for (const ExposureValue& v : values) {
    Sums& g = by_name[v.experiment];
    const Eigen::Vector2d row(1, v.exposure_s - c.x);
    const double y = v.value - c.y;
    g.n += 1;
    g.sx += row;
    g.xx += row * row.transpose();
    g.xy += row * y;
    g.sy += y;
    g.yy += y * y;
  }
  std::vector<Sums> groups;
  groups.reserve(by_name.size());
  for (auto& [name, g] : by_name) groups.push_back(g);
  return groups;
}

bool one_exposure(std::span<const ExposureValue> values) {
  return std::all_of(values.begin(), values.end(),
                     [&](const ExposureValue& v) { return v.exposure_s == values.front().exposure_s; });
}

std::array<double, 2> interval(double middle, double se, double freedom) {
  const double t = student_t_quantile(0.975, freedom);
  return {middle - t * se, middle + t * se};
}

// Covariance of the coefficients for heteroscedastic scatter: MacKinnon and White's HC3, from the residuals
// of the whitened values (those of an experiment minus their common part), each divided by one minus its
// leverage. For homoscedastic scatter the expectation is the ordinary covariance.
Eigen::Matrix2d hc3_covariance(std::span<const ExposureValue> values, Centre c, const Trial& t,
                               double ratio) {
  struct Sum {
    double n = 0, residual = 0;
    Eigen::Vector2d row = Eigen::Vector2d::Zero();
  };
  const auto row_of = [&](const ExposureValue& v) { return Eigen::Vector2d(1, v.exposure_s - c.x); };
  const auto residual_of = [&](const ExposureValue& v) { return v.value - c.y - row_of(v).dot(t.beta); };
  std::map<std::string, Sum> sums;
  for (const ExposureValue& v : values) {
    Sum& s = sums[v.experiment];
    s.n += 1;
    s.residual += residual_of(v);
    s.row += row_of(v);
  }
  const Eigen::Matrix2d inverse = t.information.inverse();
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
  for (const ExposureValue& v : values) {
    const Sum& s = sums[v.experiment];
    const double common = (1 - 1 / std::sqrt(1 + s.n * ratio)) / s.n;
    const Eigen::Vector2d row = row_of(v) - common * s.row;
    const double leverage = std::min(row.dot(inverse * row), 0.99);
    const double residual = (residual_of(v) - common * s.residual) / (1 - leverage);
    meat += row * row.transpose() * (residual * residual);
  }
  return inverse * meat * inverse;
}

}  // namespace

std::optional<ExposureLine> pooled_line(std::span<const ExposureValue> values) {
  if (values.size() < 3 || one_exposure(values)) return {};
  std::vector<double> x, y;
  std::set<std::string> experiments;
  for (const ExposureValue& v : values) {
    x.push_back(v.exposure_s);
    y.push_back(v.value);
    experiments.insert(v.experiment);
  }
  const LineFit fit = fit_line(x, y);
  return ExposureLine{fit.slope, fit.intercept,      fit.slope_ci95(),       fit.intercept_ci95(), fit.sd,
                      0,         int(values.size()), int(experiments.size())};
}

std::optional<ExposureLine> mixed_line(std::span<const ExposureValue> values) {
  auto line = pooled_line(values);
  if (!line || line->experiments < 2) return line;
  if (line->values < line->experiments + 2) return {};
  Centre c;
  for (const ExposureValue& v : values) {
    c.x += v.exposure_s / line->values;
    c.y += v.value / line->values;
  }
  const std::vector<Sums> groups = groups_of(values, c);
  const double n = line->values;
  // The criterion is smooth in the logarithm of the ratio: a scan over ten decades, then a golden-section
  // search.
  const auto criterion = [&](double log_ratio) { return solve(groups, std::exp(log_ratio), n).criterion; };
  constexpr int kSteps = 92;
  double best = std::log(1e-5);
  for (int i = 1; i <= kSteps; ++i)
    if (const double l = std::log(1e-5) + 0.25 * i; criterion(l) < criterion(best)) best = l;
  double a = best - 0.25, b = best + 0.25;
  for (int i = 0; i < 60; ++i) {
    const double p = a + 0.381966 * (b - a), q = b - 0.381966 * (b - a);
    (criterion(p) < criterion(q) ? b : a) = criterion(p) < criterion(q) ? q : p;
  }
  double ratio = std::exp((a + b) / 2);
  if (solve(groups, 0, n).criterion <= solve(groups, ratio, n).criterion) ratio = 0;

  const Trial t = solve(groups, ratio, n);
  const Eigen::Matrix2d homoscedastic = t.information.inverse() * t.variance;
  const Eigen::Matrix2d robust = hc3_covariance(values, c, t, ratio);
  const bool differ = ratio > 1e-4;
  const double slope_freedom = differ ? n - line->experiments - 1 : n - 2;
  const double intercept_freedom = differ ? line->experiments - 1 : n - 2;
  line->slope = t.beta[1];
  line->intercept = c.y + t.beta[0] - t.beta[1] * c.x;
  // The larger of both: HC3 can be too small for few values.
  const double of_slope = std::max(homoscedastic(1, 1), robust(1, 1));
  const auto at_zero = [&](const Eigen::Matrix2d& m) {
    return m(0, 0) - 2 * c.x * m(0, 1) + c.x * c.x * m(1, 1);
  };
  const double of_intercept = std::max({at_zero(homoscedastic), at_zero(robust), 0.0});
  line->slope_ci95 = interval(line->slope, std::sqrt(of_slope), slope_freedom);
  line->intercept_ci95 = interval(line->intercept, std::sqrt(of_intercept), intercept_freedom);
  line->scatter_sd = std::sqrt(t.variance);
  line->experiment_sd = std::sqrt(ratio * t.variance);
  return line;
}

std::optional<Cutoff> response_cutoff(std::span<const ExposureResponse> samples) {
  std::vector<double> exposures;
  for (const auto& s : samples) exposures.push_back(s.exposure_s);
  std::sort(exposures.begin(), exposures.end());
  exposures.erase(std::unique(exposures.begin(), exposures.end()), exposures.end());
  std::optional<Cutoff> best;
  // Cut i is before exposure i; cut 0 is before all exposures and the last cut after all.
  std::size_t at = 0;
  int fewest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i <= exposures.size(); ++i) {
    int wrong = 0;
    for (const auto& s : samples) {
      const bool before = i == exposures.size() || s.exposure_s < exposures[i];
      wrong += before != s.responds;
    }
    if (wrong < fewest) {
      fewest = wrong;
      at = i;
    }
  }
  if (at == 0 || at == exposures.size()) return {};
  best = Cutoff{(exposures[at - 1] + exposures[at]) / 2, {exposures[at - 1], exposures[at]}, fewest};
  return best;
}

}  // namespace faba
