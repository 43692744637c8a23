#pragma once
#include <vector>

#include "field/field.h"

namespace faba {

/// Currents (A) that make the in-plane field `wanted` (T, the Earth's field not counted) at `at`: of all that
/// do, the ones with the least sum of squares. When the coils cannot make one direction at that point, the
/// nearest field is made; all zero when they make none, and where `wanted`, the field of the coils at
/// `at` or the answer is not finite.
std::vector<double> allocate(const Field& field, Vec3 at, Vec2 wanted);

}  // namespace faba
