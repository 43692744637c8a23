#pragma once
#include <vector>

#include "field/field.h"

namespace faba {

/// Currents (A) that make the in-plane field `wanted` (T, without the Earth's field) at `at`: the solution
/// with the least sum of squares. When the coils cannot make a direction at that point, the nearest field is
/// made. All currents are zero when the coils make no field there, and when `wanted`, the field of the coils
/// or the solution is not finite.
std::vector<double> allocate(const Field& field, Vec3 at, Vec2 wanted);

}  // namespace faba
