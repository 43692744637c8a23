// Statistics of a calibration against closed forms, and the calibration of the search itself on a model with
// a known posterior.
#include "study/calibrate/rank_statistics.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/random/distributions.h"
#include "study/stats/study_random.h"
#include "tests/study/searched.h"

using namespace faba;

TEST_CASE("binomial distribution: closed forms") {
  CHECK(binomial_cdf(0, 3, 0.5) == doctest::Approx(0.125));
  CHECK(binomial_cdf(1, 3, 0.5) == doctest::Approx(0.5));
  CHECK(binomial_cdf(-1, 3, 0.5) == 0);
  CHECK(binomial_cdf(3, 3, 0.5) == 1);
  const BinomialRange r = binomial_range(300, 0.9, 0.99);
  CHECK(binomial_cdf(r.low - 1, 300, 0.9) <= 0.005);
  CHECK(binomial_cdf(r.low, 300, 0.9) > 0.005);
  CHECK(1 - binomial_cdf(r.high, 300, 0.9) <= 0.005);
  CHECK(1 - binomial_cdf(r.high - 1, 300, 0.9) > 0.005);
  // Clopper and Pearson: for no success the upper limit is 1 - (alpha / 2)^(1 / n).
  const FractionInterval none = binomial_interval(0, 10, 0.95), all = binomial_interval(10, 10, 0.95);
  CHECK(none.low == 0);
  CHECK(none.high == doctest::Approx(1 - std::pow(0.025, 0.1)));
  CHECK(all.low == doctest::Approx(std::pow(0.025, 0.1)));
  CHECK(all.high == 1);
  CHECK(chi_square_tail(3, 2) == doctest::Approx(std::exp(-1.5)));
}

TEST_CASE("ranks: coverage, histogram and curve") {
  std::vector<double> flat, narrow;
  for (int i = 0; i < 300; ++i) {
    flat.push_back((i + 0.5) / 300);
    narrow.push_back(i % 2 ? 0.001 : 0.999);  // the truth is always outside of the interval
  }
  const Coverage good = coverage_of(flat, 0.9), bad = coverage_of(narrow, 0.9);
  CHECK(good.inside == 270);
  CHECK(good.within());
  CHECK(bad.inside == 0);
  CHECK(!bad.within());
  const RankHistogram h = rank_histogram(flat), u = rank_histogram(narrow);
  CHECK(h.counts == std::vector<int>(20, 15));
  CHECK(h.p == doctest::Approx(1));
  CHECK(h.outside() == 0);
  CHECK(u.outside() == 20);
  CHECK(u.p < 1e-6);
  CHECK(rank_curve(flat).largest == doctest::Approx(0.5 / 300));
  CHECK(rank_curve(flat).p == doctest::Approx(1));
  CHECK(rank_curve(narrow).largest == doctest::Approx(0.499));
  CHECK(rank_curve(narrow).p < 1e-6);
}

TEST_CASE("the posterior of a linear model with normal noise is calibrated") {
  constexpr int kExperiments = 200;
  std::vector<double> ranks;
  for (int i = 0; i < kExperiments; ++i) {
    StudyRandom random(std::uint64_t(i) + 1, StudyDraws::truth);
    const auto simulate = [&](const Eigen::VectorXd& u) {
      Eigen::VectorXd s(3);
      s << u[0] + 0.05 * random.normal(), u[0] - u[1] + 0.1 * random.normal(), u[1] + 0.2 * random.normal();
      return s;
    };
    Eigen::VectorXd truth(2);
    truth << random.uniform(), random.uniform();
    const ParameterSearch s = searched(2, simulate(truth), std::uint64_t(i), simulate);
    const Eigen::MatrixXd draws = s.posterior({}, 200, std::uint64_t(i));
    ranks.push_back((double((draws.col(0).array() < truth[0]).count()) + random.uniform()) / 201);
  }
  for (const double level : kCoverageLevels) {
    const Coverage c = coverage_of(ranks, level);
    CAPTURE(level);
    CHECK_MESSAGE(c.within(), c.inside);
  }
  CHECK(rank_histogram(ranks).p > 0.005);
}
