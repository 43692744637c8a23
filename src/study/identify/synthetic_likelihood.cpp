#include "study/identify/synthetic_likelihood.h"

#include <Eigen/Dense>
#include <cmath>
#include <memory>

#include "study/stats/study_random.h"

namespace faba {
namespace {

constexpr double kPriorPrecision = 12;  // of a uniform distribution on 0 to 1; bounds uninformed parameters
constexpr int kThinning = 20;

}  // namespace

SimulationTable rows_of(const SimulationTable& t, const std::vector<Eigen::Index>& rows) {
  return {t.u(rows, Eigen::all), t.s(rows, Eigen::all)};
}

SyntheticLikelihood::SyntheticLikelihood(const SimulationTable& compression, const SimulationTable& fit,
                                         const Eigen::VectorXd& observed, const Eigen::VectorXd& centre) {
  const Emulator first(compression.u, compression.s);
  const Eigen::Index d = centre.size(), p = observed.size();
  // In units of their noise. Statistics without noise are ignored.
  const Eigen::VectorXd sd = first.covariance().diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = sd.unaryExpr([](double x) { return x > 1e-9 ? 1 / x : 0.0; });
  Eigen::MatrixXd noise = scale.asDiagonal() * first.covariance() * scale.asDiagonal();
  for (Eigen::Index j = 0; j < p; ++j)
    if (scale[j] == 0) noise(j, j) = 1;
  const Eigen::MatrixXd slope = scale.asDiagonal() * first.slope(centre);
  const Eigen::MatrixXd weighted = shrunk(noise, first.freedom()).ldlt().solve(slope).transpose();
  Eigen::MatrixXd information = weighted * slope;
  information.diagonal().array() += kPriorPrecision;
  compression_ = information.ldlt().solve(weighted) * scale.asDiagonal();
  at_centre_ = first.mean(centre);
  Eigen::MatrixXd t(fit.size(), d);
  for (Eigen::Index i = 0; i < fit.size(); ++i) t.row(i) = compressed(fit.s.row(i).transpose()).transpose();
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
