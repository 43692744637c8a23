#pragma once
#include <vector>

#include "control/controller.h"

namespace faba {

/// The obstacles of a controller in image coordinates, px.
inline std::vector<std::vector<Vec2>> obstacles_px(const Controller& controller, const Frame& frame) {
  std::vector<std::vector<Vec2>> all = controller.obstacles();
  for (std::vector<Vec2>& polygon : all)
    for (Vec2& corner : polygon) corner = frame.image_from_world(corner);
  return all;
}

}  // namespace faba
