// Score tests of changes of a linear model with normal noise.
#include "study/identify/families/misfit.h"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "study/stats/study_random.h"

using namespace faba;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kStatistics = 30;
constexpr int kSimulations = 40, kSets = 200;

VectorXd normals(Index n, StudyRandom& random) {
  VectorXd z(n);
  for (double& x : z) x = random.normal();
  return z;
}

/// Statistics that depend on two parameters, with independent noise of sd 1.
struct Example {
  StudyRandom random{3, StudyDraws{20}};
  MatrixXd slope{kStatistics, 2};
  VectorXd change = VectorXd::Zero(kStatistics);
  Example() {
    for (Index j = 0; j < 2; ++j) slope.col(j) = 10 * normals(kStatistics, random);
    change = normals(kStatistics, random);
  }
  ModelPrediction prediction() {
    ModelPrediction m{MatrixXd(kSimulations, kStatistics), slope,
                      MatrixXd::Identity(kStatistics, kStatistics), 1000};
    for (int i = 0; i < kSimulations; ++i) m.simulated.row(i) = normals(kStatistics, random).transpose();
    return m;
  }
  /// Component of the change that the parameters cannot produce.
  double strength() const {
    const VectorXd rest = change - slope * (slope.transpose() * slope).inverse() * slope.transpose() * change;
    return rest.norm();
  }
};

}  // namespace

TEST_CASE("score test: a model that is right is rejected as often as the level says") {
  Example e;
  int rejected = 0;
  for (int k = 0; k < kSets; ++k)
    rejected += score_test(e.prediction(), normals(kStatistics, e.random), e.change, true).p < 0.1;
  // 20 of 200, with a standard deviation of 4.2.
  CHECK(rejected > 20 - 4 * 4.2);
  CHECK(rejected < 20 + 4 * 4.2);
}

TEST_CASE("score test: the amount of a change is estimated, whatever the parameters are") {
  Example e;
  double sum = 0;
  for (int k = 0; k < kSets; ++k) {
    // The parameters are off by 0.02, twice the accuracy that the statistics give (0.1 / sqrt(30)).
    const VectorXd seen =
        normals(kStatistics, e.random) + 2 * e.change + e.slope * VectorXd::Constant(2, 0.02);
    const ScoreTest t = score_test(e.prediction(), seen, e.change, false);
    sum += t.amount / kSets;
    CHECK(t.p < 1e-3);
  }
  // The mean of the simulations adds 1/40 to the variance of an estimate, 1 / strength^2.
  const double sd = std::sqrt(1.025 / kSets) / e.strength();
  CHECK(std::fabs(sum - 2) < 4 * sd + 0.02);
}

TEST_CASE("score test: a change that the parameters can produce as well is not significant") {
  Example e;
  e.change = e.slope.col(0);
  int significant = 0;
  for (int k = 0; k < 20; ++k)
    significant +=
        score_test(e.prediction(), normals(kStatistics, e.random) + e.change, e.change, false).p < 1e-3;
  CHECK(significant == 0);
  e.change.setZero();
  CHECK(score_test(e.prediction(), normals(kStatistics, e.random), e.change, false).p == 1);
}

TEST_CASE("predicted shift: estimated from the other statistics only") {
  Example e;
  std::vector<Index> others, columns;
  for (Index k = 0; k < kStatistics; ++k) (k < 25 ? others : columns).push_back(k);
  VectorXd seen = 2 * e.change;
  const ModelPrediction m = e.prediction();
  const VectorXd shift = predicted_shift(m, seen, e.change, false, others, columns);
  seen(columns).setConstant(1e3);
  CHECK(predicted_shift(m, seen, e.change, false, others, columns) == shift);
  // A negative amount of a one-sided change is impossible.
  CHECK(predicted_shift(m, -seen, e.change, false, others, columns).norm() == 0);
}
