#include "study/identify/experiment_bootstrap.h"

#include <Eigen/Dense>
#include <algorithm>

#include "study/stats/statistics.h"
#include "study/stats/study_random.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kResamples = 1000;
constexpr double kStep = 0.5;                  // of finite differences, in sd of the posterior
constexpr double kUniformVariance = 1.0 / 12;  // of the prior; it bounds parameters without information

/// Quadratic approximation of a log-likelihood at a point: gradient and negative Hessian.
struct Parabola {
  VectorXd slope;
  MatrixXd curvature;
};

Parabola parabola_of(const SyntheticLikelihood& l, const VectorXd& centre, const VectorXd& step) {
  const Index d = centre.size();
  const auto at = [&](Index i, double a, Index j, double b) {
    VectorXd u = centre;
    u[i] += a * step[i];
    u[j] += b * step[j];
    return l.log_likelihood(u);
  };
  const double here = l.log_likelihood(centre);
  Parabola p{VectorXd(d), MatrixXd(d, d)};
  for (Index i = 0; i < d; ++i) {
    const double up = at(i, 1, i, 0), down = at(i, -1, i, 0);
    p.slope[i] = (up - down) / (2 * step[i]);
    p.curvature(i, i) = (2 * here - up - down) / (step[i] * step[i]);
    for (Index j = 0; j < i; ++j)
      p.curvature(i, j) = p.curvature(j, i) =
          -(at(i, 1, j, 1) - at(i, 1, j, -1) - at(i, -1, j, 1) + at(i, -1, j, -1)) / (4 * step[i] * step[j]);
  }
  return p;
}

}  // namespace

std::vector<std::array<double, 2>> resampled_estimates(const ParameterSearch& search,
                                                       const std::vector<std::vector<Index>>& experiments,
                                                       const VectorXd& centre, const VectorXd& sd,
                                                       std::uint64_t seed) {
  if (experiments.size() < 3) return {};
  const Index d = centre.size();
  std::vector<Parabola> each;
  each.reserve(experiments.size());
  for (const auto& columns : experiments)
    each.push_back(parabola_of(search.likelihood(columns), centre, kStep * sd));
  StudyRandom random(seed, StudyDraws::bootstrap);
  std::vector<std::vector<double>> estimates(static_cast<std::size_t>(d));
  for (int k = 0; k < kResamples; ++k) {
    VectorXd slope = VectorXd::Zero(d);
    MatrixXd curvature = MatrixXd::Identity(d, d) / kUniformVariance;
    for (std::size_t e = 0; e < each.size(); ++e) {
      const Parabola& drawn = each[random.below(each.size())];
      slope += drawn.slope;
      curvature += drawn.curvature;
    }
    const VectorXd u = centre + curvature.ldlt().solve(slope);
    for (Index j = 0; j < d; ++j) estimates[std::size_t(j)].push_back(std::clamp(u[j], 0.0, 1.0));
  }
  std::vector<std::array<double, 2>> out;
  out.reserve(estimates.size());
  for (const auto& e : estimates) out.push_back({quantile(e, 0.05), quantile(e, 0.95)});
  return out;
}

bool experiments_differ(const std::array<double, 2>& resampled90, const std::array<double, 2>& ci90) {
  constexpr double kMostWider = 2;  // a 3 sd event for four experiments
  return resampled90[1] - resampled90[0] > kMostWider * (ci90[1] - ci90[0]);
}

}  // namespace faba
