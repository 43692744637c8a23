#pragma once
#include <array>
#include <span>
#include <vector>

#include "field/field.h"

namespace faba {

/// Eigenvalues of the in-plane gradient of B at a point, T/m, in ascending order. North-seeking cells gather
/// where both are negative.
using NullGradient = std::array<double, 2>;
NullGradient null_gradient(const Field& field, std::span<const double> current, Vec2 at);

/// A zero of the in-plane field and its effect on a swarm.
struct FieldNull {
  std::vector<double> current;  ///< A, one per coil
  NullGradient gradient{};
  double out_of_plane = 0;  ///< dB_z/dz, T/m; minus their sum
  bool reachable = false;   ///< the currents make the zero within the limits
  bool saddle = true;       ///< cells of the given polarity are driven away along one direction
};

/// Currents that place a zero of the in-plane field at `at` (m, world, z = 0), the Earth's field included
/// unless `with_earth` is false, and trap cells of `polarity` (+1 north-seeking, -1 south-seeking) there as
/// strongly as the current limits `most` (A, one per coil) permit (theory C6). The zero requires
/// A I = -B_earth, A the 2 x coils matrix of field per ampere; the remaining freedom in I maximises the
/// weaker of the two trapping gradients. Where no currents trap along both axes, as with two coils, the
/// result is the saddle with the strongest trapping gradient. `reachable` is false where the limits do not
/// permit the zero, and outside a measured map; in the latter case the gradients are NaN.
FieldNull null_at(const Field& field, Vec2 at, int polarity, std::span<const double> most,
                  bool with_earth = true);

/// The current limits of the coils, A; 1 A for a coil without a limit.
std::vector<double> current_limits(const Field& field);

/// The zero of the in-plane field for given currents (A, one per coil), by Newton's method from `from`, m.
/// NaN when the method diverges or does not converge in 50 steps.
Vec2 find_null(const Field& field, std::span<const double> current, Vec2 from);

}  // namespace faba
