#pragma once
#include "scene.h"

namespace faba::bench {

/// A value with its theoretical expectation.
struct Check {
  std::string what;
  double value, expected, tolerance;
  bool ok() const { return value >= expected - tolerance && value <= expected + tolerance; }
};

/// Checks of a swarm after a multiple of kCycle steps. Tolerances are five standard errors of the sample, for
/// the dipole plus 0.1 % of 1 - <cos>, the bias of the integrator with this step (theory D1).
/// - `basic`, `adapted`: mean and variance of the velocity: n(n+1)/3 plus the variance of the cells' speeds
/// (A4, A5)
/// - `dipole`: 1 - <cos> equals 1 - I1/I0 of m B / kT
/// - with exclusion: the number of occupied sites equals the number of agents
/// - always: no cell is outside the box
std::vector<Check> checks(const Swarm& swarm);

/// m B / kT of the dipole scene.
double alignment();

}  // namespace faba::bench
