// Theory A16: the sums agree with their definition for every direction.
#include "study/motion/signature.h"

#include <doctest/doctest.h>

#include <random>

#include "tests/study/made_flows.h"

using namespace faba;

namespace {
constexpr double kDegree = 3.14159265358979323846 / 180;
}

TEST_CASE("activity within 45 degrees of a direction, and net flow along it, agree with their definition") {
  std::mt19937 g(2);
  std::normal_distribution<float> flow(0.1F, 1);
  FlowPair p = test::moving_quarter(0, 0, 0);
  for (float& x : p.flow.u.px) x = flow(g);
  for (float& x : p.flow.v.px) x = flow(g);
  const double threshold = 0.4;
  for (const double zero : {0.0, 7.0, -33.0}) {
    Signature s(threshold, zero);
    s.add(p, 3);
    for (double deg = zero; deg < zero + 360; deg += 15) {
      double amount = 0, along = 0;
      for (std::size_t i = 0; i < p.flow.u.px.size(); ++i) {
        const double u = double(p.flow.u.px[i]), v = double(p.flow.v.px[i]), speed = std::hypot(u, v);
        if (speed <= threshold) continue;
        const double forward = u * std::cos(deg * kDegree) + v * std::sin(deg * kDegree);
        if (forward >= std::cos(45 * kDegree) * speed) amount += std::fabs(u) + std::fabs(v);
        if (std::fabs(forward) >= std::cos(45 * kDegree) * speed) along += forward;
      }
      // Sums of about 600 floats of magnitude 1; flows within 1e-6 of the border of a sector may be in either
      // sector: one of 600 pixels would be 0.2 %.
      CHECK(s.amount(0, deg) == doctest::Approx(9 * amount).epsilon(1e-5));
      CHECK(s.along(0, deg) == doctest::Approx(9 * along).epsilon(1e-4));
    }
  }
}

TEST_CASE("noise without a direction increases the activity but not the flow along a direction") {
  std::mt19937 g(3);
  std::normal_distribution<float> noise(0, 1);
  Signature s(0.5, 0);
  double amount = 0, along = 0, squares = 0;
  const int pairs = 200;
  for (int k = 0; k < pairs; ++k) {
    FlowPair p = test::moving_quarter(std::uint64_t(k), 0, 0);
    for (float& x : p.flow.u.px) x = noise(g);
    for (float& x : p.flow.v.px) x = noise(g);
    s.add(p, 1);
    amount += s.amount(std::size_t(k), 90);
    along += s.along(std::size_t(k), 90);
    squares += s.along(std::size_t(k), 90) * s.along(std::size_t(k), 90);
  }
  CHECK(amount / pairs > 100);                       // a quarter of 640 pixels, each about 1
  CHECK(std::fabs(along) < 4 * std::sqrt(squares));  // four standard errors of a sum of zero mean
}

TEST_CASE("the nearest direction with complete sectors, and times") {
  Signature s(0.1, 10);
  s.add(test::moving_quarter(4, 1, 0), 1);
  CHECK(s.nearest_deg(10) == doctest::Approx(10));
  CHECK(s.nearest_deg(31) == doctest::Approx(25));
  CHECK(s.nearest_deg(-2) == doctest::Approx(355));
  CHECK(s.t_s(0) == doctest::Approx(0.45));
  CHECK(s.sum(0).x == doctest::Approx(160));
  CHECK(s.speed(0) == doctest::Approx(160));
}
