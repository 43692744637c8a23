#include "study/uturn/cell_drag.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace faba;

TEST_CASE("rotational drag: a sphere, the transition to it, and a long rod") {
  constexpr double kEta = 0.89e-3;
  const double sphere = 8 * std::numbers::pi * kEta * std::pow(0.7e-6, 3);
  CHECK(rotational_drag(1.4e-6, 1.4e-6, kEta) == doctest::Approx(sphere).epsilon(1e-12));
  CHECK(rotational_drag(1.4e-6 * 1.000999, 1.4e-6, kEta) ==
        doctest::Approx(rotational_drag(1.4e-6 * 1.001001, 1.4e-6, kEta)).epsilon(1e-5));
  // Limit of a long ellipsoid with half length a and elongation p: 8 pi eta a^3 / (3 (ln(2 p) - 1/2)), with
  // an error of the order of ln(p) / p^2.
  const double p = 100, a = 5e-6;
  CHECK(
      rotational_drag(2 * a, 2 * a / p, kEta) ==
      doctest::Approx(8 * std::numbers::pi * kEta * a * a * a / (3 * (std::log(2 * p) - 0.5))).epsilon(2e-3));
}
