#include "study/identify/synthetic_likelihood.h"

#include <Eigen/Dense>
#include <cmath>
#include <memory>

#include "study/stats/study_random.h"

namespace faba {
namespace {

constexpr double kPriorPrecision = 12;  // of a uniform distribution on 0 to 1; bounds uninformed parameters
constexpr int kThinning = 20;
constexpr Eigen::Index kFolds = 5;  // of the simulations, each compressed by the others

// All simulations but those of a fold of `fit`.
SimulationTable without_fold(const SimulationTable& fit, Eigen::Index fold, const SimulationTable& more) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < fit.size(); ++i)
    if (i % kFolds != fold) rows.push_back(i);
  const SimulationTable rest = rows_of(fit, rows);
  SimulationTable all{Eigen::MatrixXd(rest.size() + more.size(), fit.u.cols()),
                      Eigen::MatrixXd(rest.size() + more.size(), fit.s.cols())};
  all.u << rest.u, more.u;
  all.s << rest.s, more.s;
  return all;
}

/// Estimate of the parameters relative to a centre: weights * statistics - at_centre.
struct LinearEstimate {
  Eigen::MatrixXd weights;
  Eigen::VectorXd at_centre;
};

LinearEstimate linear_estimate(const SimulationTable& simulations, const Eigen::VectorXd& centre) {
  const Emulator emulator(simulations.u, simulations.s);
  // In units of their noise. Statistics without noise are ignored.
  const Eigen::MatrixXd covariance = emulator.covariance();
  const Eigen::VectorXd scale =
      covariance.diagonal().cwiseSqrt().unaryExpr([](double sd) { return sd > 1e-9 ? 1 / sd : 0.0; });
  Eigen::MatrixXd noise = scale.asDiagonal() * covariance * scale.asDiagonal();
  for (Eigen::Index j = 0; j < scale.size(); ++j)
    if (scale[j] == 0) noise(j, j) = 1;
  const Eigen::MatrixXd slope = scale.asDiagonal() * emulator.slope(centre);
  const Eigen::MatrixXd weighted = shrunk(noise, emulator.freedom()).ldlt().solve(slope).transpose();
  Eigen::MatrixXd information = weighted * slope;
  information.diagonal().array() += kPriorPrecision;
  LinearEstimate e;
  e.weights = information.ldlt().solve(weighted) * scale.asDiagonal();
  e.at_centre = e.weights * emulator.mean(centre);
  return e;
}

}  // namespace

SimulationTable rows_of(const SimulationTable& t, const std::vector<Eigen::Index>& rows) {
  return {t.u(rows, Eigen::all), t.s(rows, Eigen::all)};
}

SyntheticLikelihood::SyntheticLikelihood(const SimulationTable& fit, const SimulationTable& more,
                                         const Eigen::VectorXd& observed, const Eigen::VectorXd& centre) {
  const Eigen::Index d = centre.size();
  compression_ = Eigen::MatrixXd::Zero(d, observed.size());
  at_centre_ = Eigen::VectorXd::Zero(d);
  Eigen::MatrixXd t(fit.size(), d);
  for (Eigen::Index fold = 0; fold < kFolds; ++fold) {
    const LinearEstimate e = linear_estimate(without_fold(fit, fold, more), centre);
    for (Eigen::Index i = fold; i < fit.size(); i += kFolds)
      t.row(i) = (e.weights * fit.s.row(i).transpose() - e.at_centre).transpose();
    compression_ += e.weights / double(kFolds);
    at_centre_ += e.at_centre / double(kFolds);
  }
  observed_ = compressed(observed);
  emulator_ = std::make_unique<Emulator>(fit.u, t);
  Eigen::MatrixXd covariance = emulator_->covariance();
  covariance.diagonal().array() += 1e-12;
  precision_ = covariance.inverse();
}

double SyntheticLikelihood::log_likelihood(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd off = observed_ - emulator_->mean(u);
  const double d = double(off.size()), wider = 1 + emulator_->leverage(u), freedom = emulator_->freedom();
  const double q = off.dot(precision_ * off) / wider;
  return -0.5 * (freedom + d) * std::log1p(q / freedom) - 0.5 * d * std::log(wider);
}

Eigen::MatrixXd sample(const std::function<double(const Eigen::VectorXd&)>& log_density,
                       const ParameterBox& box, const Eigen::VectorXd& start, const Eigen::MatrixXd& spread,
                       int count, std::uint64_t seed) {
  const Eigen::Index d = start.size();
  StudyRandom random(seed, StudyDraws::posterior);
  Eigen::VectorXd at = start.cwiseMax(box.low).cwiseMin(box.high), mean = at;
  double density = log_density(at);
  Eigen::MatrixXd covariance = spread, draws(count, d);
  const int warm_up = 2000 + 200 * int(d), steps = warm_up + count * kThinning;
  double step = 2.38 / std::sqrt(double(d));
  const auto factor = [&] {
    Eigen::MatrixXd c = covariance;
    c.diagonal().array() += 1e-10;
    return Eigen::MatrixXd(c.llt().matrixL());
  };
  Eigen::MatrixXd root = factor();
  int accepted = 0, since = 0;
  for (int i = 0; i < steps; ++i) {
    Eigen::VectorXd z(d);
    for (Eigen::Index j = 0; j < d; ++j) z[j] = random.normal();
    const Eigen::VectorXd proposal = at + step * (root * z);
    const double proposed_density = box.contains(proposal) ? log_density(proposal) : -HUGE_VAL;
    const double threshold = std::log(random.uniform());
    if (threshold < proposed_density - density) {
      at = proposal;
      density = proposed_density;
      ++accepted;
    }
    ++since;
    if (i < warm_up) {
      // Running mean and covariance of the chain, with exponential forgetting.
      const double rate = 1.0 / (20 + 0.5 * i);
      const Eigen::VectorXd off = at - mean;
      mean += rate * off;
      covariance = (1 - rate) * covariance + rate * off * off.transpose();
      if (since == 100) {
        step *= std::exp((double(accepted) / since - 0.25));
        root = factor();
        accepted = since = 0;
      }
    } else if ((i - warm_up) % kThinning == 0) {
      draws.row((i - warm_up) / kThinning) = at.transpose();
    }
  }
  return draws;
}

}  // namespace faba
