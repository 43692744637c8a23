#include "study/identify/families/misfit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/random/distributions.h"
#include "study/stats/emulator.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRegular = 1e-9;  // relative: parameters without any effect
constexpr double kDistinct =
    1e-6;  // of the squared change: less is rounding, the parameters produce the change
constexpr double kLeastNoise = 1e-9;  // statistics without noise are ignored

/// Weights of the statistics in an estimate of the amount of a change.
struct Projection {
  VectorXd weights;  ///< p; the amount is their product with a deviation
  VectorXd adapted;  ///< d; change of the parameters per amount
};

Projection project(const MatrixXd& slope, const MatrixXd& covariance, int freedom, const VectorXd& change) {
  const VectorXd scale =
      covariance.diagonal().unaryExpr([](double v) { return v > kLeastNoise ? 1 / std::sqrt(v) : 0.0; });
  MatrixXd noise = scale.asDiagonal() * covariance * scale.asDiagonal();
  for (Index k = 0; k < scale.size(); ++k)
    if (scale[k] == 0) noise(k, k) = 1;
  const Eigen::LDLT<MatrixXd> factor(shrunk(noise, freedom));
  const MatrixXd s = scale.asDiagonal() * slope;
  const VectorXd c = scale.asDiagonal() * change;
  MatrixXd information = s.transpose() * factor.solve(s);
  information.diagonal().array() += kRegular * (1 + information.trace());
  Projection p;
  p.adapted = -information.ldlt().solve(s.transpose() * factor.solve(c));
  const VectorXd rest = c + s * p.adapted, weighted = factor.solve(rest);
  const double strength = rest.dot(weighted);
  p.weights = strength > kDistinct * c.dot(factor.solve(c))
                  ? VectorXd(scale.asDiagonal() * weighted / strength)
                  : VectorXd::Zero(c.size());
  return p;
}

VectorXd noise_of(const ModelPrediction& m) {
  return m.covariance.diagonal().cwiseSqrt().cwiseMax(kLeastNoise);
}

}  // namespace

ScoreTest score_test(const ModelPrediction& m, const VectorXd& observed, const VectorXd& change,
                     bool two_sided) {
  const Projection p = project(m.slope, m.covariance, m.freedom, change);
  const VectorXd mean = m.simulated.colwise().mean().transpose();
  const VectorXd amounts = (m.simulated.rowwise() - mean.transpose()) * p.weights;
  const double n = double(amounts.size());
  ScoreTest t;
  t.amount = p.weights.dot(observed - mean);
  t.sd = std::sqrt(amounts.squaredNorm() / (n - 1) * (1 + 1 / n));
  if (!(t.sd > 0)) return t;
  t.t = t.amount / t.sd;
  t.effect = (t.amount * change).cwiseAbs().maxCoeff();
  const double upper = 1 - student_t_cdf(two_sided ? std::fabs(t.t) : t.t, n - 1);
  t.p = std::min(1.0, two_sided ? 2 * upper : upper);
  const VectorXd noise = noise_of(m), before = (observed - mean).cwiseQuotient(noise),
                 after = before - t.amount * (change + m.slope * p.adapted).cwiseQuotient(noise);
  t.explained = 1 - after.squaredNorm() / std::max(before.squaredNorm(), 1e-300);
  return t;
}

VectorXd predicted_shift(const ModelPrediction& m, const VectorXd& observed, const VectorXd& change,
                         bool two_sided, const std::vector<Index>& others,
                         const std::vector<Index>& columns) {
  const Projection p =
      project(m.slope(others, Eigen::all), m.covariance(others, others), m.freedom, change(others));
  const VectorXd mean = m.simulated.colwise().mean().transpose();
  const double amount = p.weights.dot(observed(others) - mean(others));
  const VectorXd shift = change + m.slope * p.adapted;
  return (two_sided ? amount : std::max(0.0, amount)) * shift(columns);
}

}  // namespace faba
