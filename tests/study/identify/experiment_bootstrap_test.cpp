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
constexpr double kNoise = 0.12;  // sd of the only statistic of an experiment, which is the parameter itself

/// Width of the interval relative to that from the noise within experiments, mean over many sets;
/// `between_sd`: sd of the true values between experiments.
double relative_width(double between_sd) {
  std::vector<std::vector<Index>> experiments;
  for (Index e = 0; e < kExperiments; ++e) experiments.push_back({e});
  double sum = 0;
  for (int k = 0; k < kSets; ++k) {
    StudyRandom random(std::uint64_t(k), StudyDraws{4});
    VectorXd seen(kExperiments);
    for (double& s : seen) s = 0.5 + between_sd * random.normal() + kNoise * random.normal();
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

// The bootstrap sd of the mean of 8 numbers is sqrt(7/8) of the true one, and the 90 % interval is narrower
// by about 2 % for so few numbers; with 30 sets the accuracy is 1/sqrt(2 * 7 * 30) = 5 %. The slopes of the
// likelihood add a few per cent.
TEST_CASE("experiment bootstrap: the interval reflects the variation between experiments") {
  const double expected = std::sqrt(7.0 / 8);
  CHECK(relative_width(0) == doctest::Approx(expected).epsilon(0.15));
  CHECK(relative_width(2 * kNoise) == doctest::Approx(std::sqrt(5.0) * expected).epsilon(0.15));
}

TEST_CASE("experiment bootstrap: no interval for two experiments") {
  const VectorXd seen = VectorXd::Constant(2, 0.5);
  StudyRandom random(1, StudyDraws{4});
  const ParameterSearch s = searched(1, seen, 1, [&](const VectorXd& u) {
    return VectorXd{{u[0] + kNoise * random.normal(), u[0] + kNoise * random.normal()}};
  });
  CHECK(
      resampled_estimates(s, {{0}, {1}}, VectorXd::Constant(1, 0.5), VectorXd::Constant(1, 0.1), 1).empty());
}

TEST_CASE("experiment bootstrap: experiments differ if the interval is wide, not if it is shifted") {
  const std::array<double, 2> ci90{100, 120};  // median 110
  CHECK_FALSE(experiments_differ({111, 129}, ci90));
  CHECK_FALSE(experiments_differ({90, 128}, ci90));
  CHECK(experiments_differ({80, 130}, ci90));
}
