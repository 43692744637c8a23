#pragma once
#include "core/vec.h"

namespace faba {

/// A circle in a plane, in the unit and frame of its points.
struct Circle {
  Vec2 centre;
  double radius = 0;  ///< > 0
};

}  // namespace faba
