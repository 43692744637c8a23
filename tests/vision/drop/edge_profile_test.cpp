#include "vision/drop/edge_profile.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace faba;

namespace {

std::vector<double> profile(double step, double ring, double at, double width, double slope = 0) {
  std::vector<double> grey;
  for (int i = -16; i <= 16; ++i) {
    const double u = (i - at) / width;
    grey.push_back(1000 + slope * i + step * 0.5 * std::erfc(-u / std::numbers::sqrt2) +
                   ring * std::exp(-0.5 * u * u));
  }
  return grey;
}

}  // namespace

TEST_CASE("step, line and step with line are distinguished and located, also in uneven light") {
  for (const double at : {-6.3, -0.4, 0.0, 3.77})
    for (const double slope : {0.0, 0.7}) {
      const EdgeProfile step = fit_edge_profile(profile(-30, 0, at, 2, slope));
      CHECK(step.shape == EdgeShape::step);
      // The final search mesh is 1/2^9 of a sample in position and a factor of 1.001 in width.
      CHECK(step.position == doctest::Approx(at).epsilon(0.004));
      CHECK(step.width == doctest::Approx(2).epsilon(0.01));
      CHECK(step.step == doctest::Approx(-30).epsilon(0.01));
      CHECK(step.explained > 0.999);

      const EdgeProfile line = fit_edge_profile(profile(0, -25, at, 1.6, slope));
      CHECK(line.shape == EdgeShape::ring);
      CHECK(line.position == doctest::Approx(at).epsilon(0.004));
      CHECK(line.ring == doctest::Approx(-25).epsilon(0.01));
    }
  const EdgeProfile both = fit_edge_profile(profile(20, -30, 1.3, 2.5));
  CHECK(both.shape == EdgeShape::step_ring);
  CHECK(both.position == doctest::Approx(1.3).epsilon(0.01));
  CHECK(both.step == doctest::Approx(20).epsilon(0.02));
  CHECK(both.ring == doctest::Approx(-30).epsilon(0.02));
}

TEST_CASE("a bright rim does not shift a step inward") {
  // The inside of the drop is brightest at the rim: a step of 100 with a shoulder of 15 px.
  std::vector<double> grey;
  for (int i = -16; i <= 16; ++i)
    grey.push_back(40 + 0.5 * std::erfc(i / 2.0 / std::numbers::sqrt2) * (100 + 20 * std::exp(i / 8.0)));
  const EdgeProfile p = fit_edge_profile(grey);
  CHECK(p.shape == EdgeShape::step);
  // The half level shifts by less than the width of the step, 2 px.
  CHECK(std::fabs(p.position) < 2);
}

TEST_CASE("uniform grey and linear gradients have no edge") {
  CHECK(fit_edge_profile(std::vector<double>(33, 7.0)).explained == 0);
  CHECK(fit_edge_profile(profile(0, 0, 0, 1, 2)).explained < 1);
}
