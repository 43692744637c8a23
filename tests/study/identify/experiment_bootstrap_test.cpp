#include "study/identify/experiment_bootstrap.h"

#include <doctest/doctest.h>

#include <cmath>

#include "study/stats/study_random.h"
#include "tests/study/searched.h"

using namespace faba;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr int kExperiments = 8, kSets = 30;
constexpr double kNoise = 0.12;  // of the one statistic of an experiment, which is the parameter itself

/// The width of the interval over that which chance inside of experiments makes, mean over many sets;
/// `differ`: sd of the experiments' own truths.
double width(double differ) {
  std::vector<std::vector<Index>> experiments;
  for (Index e = 0; e < kExperiments; ++e) experiments.push_back({e});
  double sum = 0;
  for (int k = 0; k < kSets; ++k) {
    StudyRandom random(std::uint64_t(k), StudyDraws{4});
    VectorXd seen(kExperiments);
    for (double& s : seen) s = 0.5 + differ * random.normal() + kNoise * random.normal();
    const ParameterSearch s = searched(1, seen, std::uint64_t(k), [&](const VectorXd& u) {
      VectorXd out(kExperiments);
      for (double& x : out) x = u[0] + kNoise * random.normal();
      return out;
    });
    const double sd = kNoise / std::sqrt(double(kExperiments));
    const auto found =
        resampled_estimates(s, experiments, VectorXd::Constant(1, seen.mean()), VectorXd::Constant(1, sd), 1);
    sum += (found.at(0)[1] - found.at(0)[0]) / (2 * 1.645 * sd) / kSets;
  }
  return sum;
}

}  // namespace

// Of 8 numbers drawn anew the mean has sqrt(7/8) of its own sd, and 90 % of it are the narrower for being
// from so few, by some 2 %; known to 1/sqrt(2 * 7 * 30) = 5 % from 30 sets. Slopes of the likelihood add
// another few.
TEST_CASE("experiments that agree give as much as chance does, those that differ as much as they differ") {
  const double expected = std::sqrt(7.0 / 8);
  CHECK(width(0) == doctest::Approx(expected).epsilon(0.15));
  CHECK(width(2 * kNoise) == doctest::Approx(std::sqrt(5.0) * expected).epsilon(0.15));
}

TEST_CASE("two experiments are too few") {
  const VectorXd seen = VectorXd::Constant(2, 0.5);
  StudyRandom random(1, StudyDraws{4});
  const ParameterSearch s = searched(1, seen, 1, [&](const VectorXd& u) {
    return VectorXd{{u[0] + kNoise * random.normal(), u[0] + kNoise * random.normal()}};
  });
  CHECK(
      resampled_estimates(s, {{0}, {1}}, VectorXd::Constant(1, 0.5), VectorXd::Constant(1, 0.1), 1).empty());
}
