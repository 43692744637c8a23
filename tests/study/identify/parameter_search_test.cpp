// A model with a known posterior: statistics that are linear in the parameters, with normal noise.
#include "study/identify/parameter_search.h"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "study/stats/study_random.h"
#include "tests/study/searched.h"

using namespace faba;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kParameters = 2, kStatistics = 7;

struct LinearModel {
  MatrixXd a{kStatistics, kParameters};
  MatrixXd root{kStatistics, kStatistics};  ///< square root of the noise covariance
  LinearModel() {
    StudyRandom random(5, StudyDraws{1});
    for (Index i = 0; i < kStatistics; ++i) {
      for (Index j = 0; j < kParameters; ++j) a(i, j) = 3 * random.normal();
      for (Index j = 0; j < kStatistics; ++j) root(i, j) = i == j ? 0.3 : 0.1 * random.normal();
    }
  }
  VectorXd simulate(const VectorXd& u, StudyRandom& random) const {
    VectorXd z(kStatistics);
    for (double& x : z) x = random.normal();
    return a * u + root * z;
  }
  MatrixXd precision() const { return a.transpose() * (root * root.transpose()).inverse() * a; }
  VectorXd best(const VectorXd& s) const {
    return precision().inverse() * a.transpose() * (root * root.transpose()).inverse() * s;
  }
};

double quantile(VectorXd v, double p) {
  std::sort(v.begin(), v.end());
  return v[Index(p * double(v.size() - 1))];
}

}  // namespace

TEST_CASE("parameter search: posterior mean, width and coverage for a linear model") {
  const LinearModel model;
  const VectorXd sd = model.precision().inverse().diagonal().cwiseSqrt();
  REQUIRE(sd.maxCoeff() < 0.1);  // far from the limits of the ranges the prior has no effect
  constexpr int kSets = 40;
  double off = 0, ratio = 0, covered = 0, abc_covered = 0;
  for (int k = 0; k < kSets; ++k) {
    StudyRandom random(100 + std::uint64_t(k), StudyDraws{2});
    VectorXd truth(kParameters);
    for (double& x : truth) x = 0.4 + 0.2 * random.uniform();
    const VectorXd seen = model.simulate(truth, random), exact = model.best(seen);
    const ParameterSearch s = searched(kParameters, seen, std::uint64_t(k),
                                       [&](const VectorXd& u) { return model.simulate(u, random); });
    const MatrixXd draws = s.posterior({}, 600, 3);
    const auto abc = s.abc_posterior();
    for (Index j = 0; j < kParameters; ++j) {
      const VectorXd u = draws.col(j);
      off += (u.mean() - exact[j]) / sd[j] / (kSets * kParameters);
      ratio += std::sqrt((u.array() - u.mean()).square().mean()) / sd[j] / (kSets * kParameters);
      covered +=
          truth[j] >= quantile(u, 0.05) && truth[j] <= quantile(u, 0.95) ? 1.0 / (kSets * kParameters) : 0;
      abc_covered += (abc.u.col(j).array() < truth[j]).select(abc.weight, 0.0).sum() > 0.05 &&
                             (abc.u.col(j).array() > truth[j]).select(abc.weight, 0.0).sum() > 0.05
                         ? 1.0 / (kSets * kParameters)
                         : 0;
    }
  }
  // The mean is that of a regression with 6 terms on 200 simulations: its error is sqrt(6 / 200) = 0.17 sd in
  // each set, 0.02 sd in the mean of 80 values; the limit is four times this error.
  CHECK(std::fabs(off) < 0.08);
  // The variance is larger than the exact one by the leverage (3 %), by the loss of the compression from
  // about 240 other simulations (7 / 240) and by Student's tails with 194 degrees of freedom (1 %): the sd
  // ratio is 1.04, with an accuracy of 0.05 / sqrt(80).
  CHECK(ratio > 1.0);
  CHECK(ratio < 1.08);
  // 90 % with an accuracy of sqrt(0.9 0.1 / 80) = 3.4 %.
  CHECK(covered > 0.9 - 3 * 0.034);
  CHECK(abc_covered > 0.9 - 4 * 0.034);
}

// As in a video: many statistics, whose noise is mainly common, for few simulations.
TEST_CASE("parameter search: coverage with nearly as many statistics as simulations") {
  constexpr Index kMany = 60;
  MatrixXd a(kMany, 1), common(kMany, 2);
  StudyRandom fixed(6, StudyDraws{1});
  for (Index i = 0; i < kMany; ++i) {
    a(i, 0) = fixed.normal();
    for (Index j = 0; j < 2; ++j) common(i, j) = 0.5 * fixed.normal();
  }
  const auto simulate = [&](const VectorXd& u, StudyRandom& random) {
    VectorXd z(2), own(kMany);
    for (double& x : z) x = random.normal();
    for (double& x : own) x = random.normal();
    return VectorXd(a * u + common * z + own);
  };
  const MatrixXd noise = common * common.transpose() + MatrixXd::Identity(kMany, kMany);
  const double sd = 1 / std::sqrt((a.transpose() * noise.inverse() * a)(0, 0));
  REQUIRE(sd < 0.15);
  constexpr int kSets = 40;
  double ratio = 0, covered = 0;
  for (int k = 0; k < kSets; ++k) {
    StudyRandom random(100 + std::uint64_t(k), StudyDraws{2});
    const VectorXd truth = VectorXd::Constant(1, 0.4 + 0.2 * random.uniform()),
                   seen = simulate(truth, random);
    const VectorXd u = searched(
                           1, seen, std::uint64_t(k),
                           [&](const VectorXd& at) { return simulate(at, random); }, SearchRounds::of(150))
                           .posterior({}, 600, 3);
    ratio += std::sqrt((u.array() - u.mean()).square().mean()) / sd / kSets;
    covered += truth[0] >= quantile(u, 0.05) && truth[0] <= quantile(u, 0.95) ? 1.0 / kSets : 0;
  }
  CAPTURE(ratio);
  CAPTURE(covered);
  CHECK(ratio < 1.3);
  // 90 % with an accuracy of sqrt(0.9 0.1 / 40) = 4.7 %.
  CHECK(covered > 0.9 - 3 * 0.047);
}

TEST_CASE("parameter search: a parameter without effect keeps its prior range") {
  const LinearModel model;
  StudyRandom random(9, StudyDraws{2});
  const VectorXd truth = VectorXd::Constant(kParameters, 0.5), seen = model.simulate(truth, random);
  const ParameterSearch s = searched(kParameters + 1, seen, 1, [&](const VectorXd& u) {
    return model.simulate(u.head(kParameters), random);
  });
  const MatrixXd draws = s.posterior({}, 1000, 3);
  const VectorXd idle = draws.col(kParameters);
  CHECK(quantile(idle, 0.95) - quantile(idle, 0.05) > 0.7);
  CHECK(std::fabs(draws.col(0).mean() - 0.5) < 0.3);
}

TEST_CASE(
    "parameter search: reproducible for a seed; failed simulations are ignored, too many give an error") {
  const LinearModel model;
  StudyRandom truth(9, StudyDraws{2});
  const VectorXd seen = model.simulate(VectorXd::Constant(kParameters, 0.5), truth);
  const auto run = [&](double failing) {
    StudyRandom random(3, StudyDraws{2});
    return searched(kParameters, seen, 1,
                    [&](const VectorXd& u) {
                      VectorXd s = model.simulate(u, random);
                      if (random.uniform() < failing) s[2] = std::nan("");
                      return s;
                    })
        .posterior({}, 200, 3);
  };
  CHECK(run(0) == run(0));
  CHECK(std::fabs(run(0.3).col(0).mean() - 0.5) < 0.3);
  CHECK_THROWS_AS(run(0.97), Error);
}
