#pragma once
#include "scene.h"

namespace faba::bench {

/// One number that theory knows.
struct Check {
  std::string what;
  double value, expected, tolerance;
  bool ok() const { return value >= expected - tolerance && value <= expected + tolerance; }
};

/// What must hold for a swarm that has advanced by whole cycles. Tolerances are five standard errors of the
/// sample; for the dipole also 0.1 % of 1 - <cos>, the integrator's bias for such steps (REFERENCE.md D1).
/// - `basic`, `adapted`: mean and variance of the held velocity, n(n+1)/3 and the innate speeds' share (A4,
/// A5)
/// - `dipole`: 1 - <cos> against 1 - I1/I0 of m B / kT
/// - with exclusion: as many occupied grid cells as agents
/// - always: nobody outside the box
std::vector<Check> checks(const Swarm& swarm);

/// m B / kT of the dipole scene.
double alignment();

}  // namespace faba::bench
