// Segments of directed motion in synthetic flows with known start and end.
#include "study/motion/segments.h"

#include <doctest/doctest.h>

#include <random>

#include "tests/study/made_flows.h"

using namespace faba;

namespace {

struct Motion {
  int from, to;  ///< pairs, 0.1 s each
  double deg, speed;
};

Signature made(int pairs, const std::vector<Motion>& motions, double noise, unsigned seed = 1) {
  std::mt19937 g(seed);
  std::normal_distribution<double> gauss(0, noise);
  Signature s(0.3, 0);
  for (int k = 0; k < pairs; ++k) {
    double u = 0, v = 0;
    for (const Motion& m : motions)
      if (k >= m.from && k < m.to) {
        const double a = m.deg * 3.14159265358979323846 / 180;
        u += m.speed * std::cos(a);
        v += m.speed * std::sin(a);
      }
    FlowPair p = test::moving_quarter(std::uint64_t(k), u, v);
    for (std::size_t i = 0; i < p.flow.u.px.size(); ++i) {
      p.flow.u.px[i] += float(gauss(g));
      p.flow.v.px[i] += float(gauss(g));
    }
    s.add(p, 1);
  }
  return s;
}

}  // namespace

TEST_CASE("intervals of motion, pauses and a direct reversal, with their directions") {
  const std::vector<Motion> truth{
      {20, 55, 270, 1}, {80, 130, 100, 0.7}, {150, 200, 0, 1}, {200, 240, 180, 1}};
  const auto found = motion_segments(made(260, truth, 0.1));
  REQUIRE(found.size() == truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // Start and end to within one pair; the direction from about 40 sums of 160 pixels, each with an error of
    // 0.3 / sqrt(160): far below one degree.
    CHECK(std::fabs(found[i].t0_s - 0.1 * truth[i].from) <= 0.11);
    CHECK(std::fabs(found[i].t1_s - 0.1 * truth[i].to) <= 0.11);
    CHECK(std::fabs(std::remainder(found[i].direction_deg - truth[i].deg, 360)) < 3);
  }
}

TEST_CASE("with a given direction only motion along it and against it is detected") {
  const std::vector<Motion> truth{{20, 55, 270, 1}, {80, 130, 60, 1}, {150, 200, 0, 1}};
  const auto found = motion_segments(made(220, truth, 0.1), 90.0);
  REQUIRE(found.size() == 2);  // motion across is ignored
  CHECK(found[0].direction_deg == doctest::Approx(270));
  CHECK(found[1].direction_deg == doctest::Approx(90));
  CHECK(std::fabs(found[1].t0_s - 8) <= 0.11);
}

TEST_CASE("noise, diffusion of one object, a short jerk and no motion are not directed motion") {
  int false_ones = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CHECK(motion_segments(made(150, {}, 0.5, seed)).empty());
    // An object that steps in a random direction in each frame.
    std::mt19937 g(seed);
    std::uniform_real_distribution<double> turn(0, 360);
    std::vector<Motion> steps;
    for (int k = 0; k < 150; ++k) steps.push_back({k, k + 1, turn(g), 1});
    false_ones += !motion_segments(made(150, steps, 0.05, seed)).empty();
  }
  // Windows of five steps often have one direction; a segment of half a second with p < 0.001 is rare: about
  // 30 independent windows in each of 20 videos give an expectation of 0.6; 4 or more occur once in 300
  // tests.
  CHECK(false_ones <= 3);
  CHECK(motion_segments(made(100, {{50, 53, 0, 2}}, 0.1)).empty());
  CHECK(motion_segments(made(50, {}, 0)).empty());
  CHECK(motion_segments(Signature(0, 0)).empty());
}
