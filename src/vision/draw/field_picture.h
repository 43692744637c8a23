#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// What to draw of a magnetic field in the plane. Positions in picture px, y down.
struct FieldScene {
  int width = 800, height = 600;
  double um_per_px = 1;
  std::vector<Vec2> b;  ///< in-plane field of every pixel, row by row, T, world frame: y up
  struct Zero {
    Vec2 at;
    std::string words;  ///< what it is, drawn beside it
  };
  std::vector<Zero> zeros;
  std::vector<std::vector<Vec2>> coils;  ///< outlines
  std::optional<Vec2> view_px;           ///< size of the camera's view about the middle, drawn as a rectangle
  double drop_radius_px = 0;             ///< 0: no drop
};

/// Magnitude in colour, logarithmic, with its scale at the right; direction as arrows; zeros, coils, view,
/// drop and scale bar. Same scene, same pixels.
RgbImage draw_field(const FieldScene& scene);

}  // namespace faba
