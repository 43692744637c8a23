#include "study/uturn/cell_drag.h"

#include <cmath>
#include <numbers>

namespace faba {

double rotational_drag(double length, double width, double viscosity) {
  const double a = length / 2, b = width / 2;
  // Near a sphere numerator and denominator vanish; the expansion to first order in a / b - 1 is used there.
  if (a / b < 1.001) return 8 * std::numbers::pi * viscosity * b * b * b * (1 + 1.2 * (a / b - 1));
  const double root = std::sqrt(a * a - b * b);
  const double s = 2 / root * std::log((a + root) / b);
  return 32 * std::numbers::pi / 3 * viscosity * (std::pow(a, 4) - std::pow(b, 4)) /
         ((2 * a * a - b * b) * s - 2 * a);
}

}  // namespace faba
