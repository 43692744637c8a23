#include "study/motion/onset.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "study/stats/study_random.h"

namespace {

using namespace faba;

constexpr double kReversal = 1, kSearched = 2;  // s

/// Displacements of a velocity of -1 that rises to 1 from `onset`, linearly within `rise`, at 30 pairs per
/// second, with noise.
struct Recording {
  std::vector<double> t0, t1, along, across;
  ShiftSeries series() const { return {t0, t1, along, across}; }
};

Recording recording(double onset, double rise, double step, double noise, std::uint64_t seed) {
  Recording r;
  StudyRandom random(seed, StudyDraws::measurement);
  constexpr double kRate = 30;
  for (int k = 0; k < 90; ++k) {
    const double a = k / kRate, b = (k + 1) / kRate;
    double mean = 0;
    for (int i = 0; i < 20; ++i)
      mean += std::min(1.0, std::max(0.0, (a + (i + 0.5) / 20 * (b - a) - onset) / rise)) / 20;
    r.t0.push_back(a);
    r.t1.push_back(b);
    r.along.push_back(step * (2 * mean - 1) + noise * random.normal());
    r.across.push_back(noise * random.normal());
  }
  return r;
}

}  // namespace

TEST_CASE("onset: the 90 % interval contains the time of a tenth of the rise, never before the reversal") {
  constexpr int kCases = 60;
  int inside = 0;
  for (int i = 0; i < kCases; ++i) {
    const double onset = kReversal + 0.03 * (i % 5), rise = 0.05 + 0.1 * (i % 3);
    const auto c = change_point(recording(onset, rise, 1, 0.15, std::uint64_t(i)).series(), kReversal, 3);
    REQUIRE(c);
    CHECK(c->ci90[0] >= kReversal);
    CHECK(c->ci90[0] <= c->t_s);
    CHECK(c->t_s <= c->ci90[1]);
    CHECK(c->t_statistic > least_t(*c, kSearched, 3));
    const double truth = onset + kOnsetFraction * rise;
    inside += c->ci90[0] <= truth && truth <= c->ci90[1];
  }
  // Binomial, 60 trials of 0.9: between 46 and 60 with probability 0.999.
  CHECK(inside >= 46);
}

TEST_CASE("onset: samples without a response exceed the limit of the test as often as stated") {
  constexpr int kCases = 200;
  int found = 0;
  for (int i = 0; i < kCases; ++i) {
    const auto c = change_point(recording(0, 1e-9, 0, 1, 1000 + std::uint64_t(i)).series(), kReversal, 3);
    found += c && c->t_statistic > least_t(*c, kSearched, 1);
  }
  // Binomial, 200 trials of kFalseResponse: at most 7 with probability 0.999.
  CHECK(found <= 7);
}

TEST_CASE("onset: no change without enough pairs on both sides") {
  const Recording r = recording(1, 0.1, 1, 0.1, 1);
  CHECK_FALSE(change_point(r.series(), 0, 3));
  CHECK_FALSE(change_point(r.series(), 2.9, 3));
}
