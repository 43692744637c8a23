#pragma once
#include "core/vec.h"

namespace faba {

/// Transform between world and image coordinates, and size of the image. World: m, origin at the arena's
/// centre, x right, y up. Image: px, pixel centres at integers, x right, y down.
struct Frame {
  double m_per_px = 1e-6;
  int width = 640, height = 480;    ///< px
  Vec2 centre_image{319.5, 239.5};  ///< image position of the arena's centre

  Vec2 image_from_world(Vec2 p_world) const {
    return {centre_image.x + p_world.x / m_per_px, centre_image.y - p_world.y / m_per_px};
  }
  Vec2 world_from_image(Vec2 p_image) const {
    return {(p_image.x - centre_image.x) * m_per_px, (centre_image.y - p_image.y) * m_per_px};
  }
  bool in_view(Vec2 p_image) const {
    return p_image.x >= -0.5 && p_image.y >= -0.5 && p_image.x < width - 0.5 && p_image.y < height - 0.5;
  }
};

/// Conversion from the units of the thesis's models (pixels, iterations, field units) to SI.
struct Scale {
  double m_per_px = 0.9164e-6;  ///< m
  double iteration = 1.0 / 15;  ///< s
  double field_unit = 23e-6;    ///< T
};

}  // namespace faba
