#pragma once
#include <array>
#include <span>
#include <vector>

#include "field/field.h"

namespace faba {

/// Eigenvalues of the in-plane gradient of B at a place, T/m, the smaller one first. North-seeking cells come
/// together where both are negative.
using NullGradient = std::array<double, 2>;
NullGradient null_gradient(const Field& field, std::span<const double> current, Vec2 at);

/// A place where the in-plane field is zero, and what a swarm does there.
struct FieldNull {
  std::vector<double> current;  ///< A, one per coil
  NullGradient gradient{};
  double out_of_plane = 0;  ///< dB_z/dz, T/m; minus their sum
  bool reachable = false;   ///< the currents make the zero, and no limit is exceeded
  bool saddle = true;       ///< cells of the polarity asked for are driven away along one direction
};

/// Currents that put a zero of the in-plane field at `at` (m, world, z = 0), the Earth's field included
/// unless `with_earth` is false, and trap cells of `polarity` (+1 north-seeking, -1 south-seeking) there as
/// strongly as the current limits `most` (A, one per coil) allow (theory C6). The zero needs A I = -B_earth,
/// A the 2 x coils matrix of field per ampere; of what is free in I the best is taken for the weaker of the
/// two trapping gradients. Where no currents trap along both axes, as with two coils, the saddle with the
/// stronger trap is given. Where the limits do not allow the zero, `reachable` is
/// false; where the field is not known, outside of a measured map, it is false and the gradients are NaN.
FieldNull null_at(const Field& field, Vec2 at, int polarity, std::span<const double> most,
                  bool with_earth = true);

/// The limits of the field's own coils; 1 A where a coil has none.
std::vector<double> current_limits(const Field& field);

/// The zero of the in-plane field for given currents (A, one per coil), by Newton's method from `from`, m.
/// Not a number when it runs off or finds none in 50 steps.
Vec2 find_null(const Field& field, std::span<const double> current, Vec2 from);

}  // namespace faba
