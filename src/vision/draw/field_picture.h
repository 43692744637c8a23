#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// Content of a picture of a magnetic field in the plane. Positions in picture px, y down.
struct FieldScene {
  int width = 800, height = 600;
  double um_per_px = 1;
  std::vector<Vec2> b;  ///< in-plane field of every pixel, row by row, T, world frame: y up
  struct Zero {
    Vec2 at;
    std::string words;  ///< label
  };
  std::vector<Zero> zeros;
  std::vector<std::vector<Vec2>> coils;  ///< outlines
  std::optional<Vec2> view_px;           ///< size of the camera view, drawn as a centred rectangle
  double drop_radius_px = 0;             ///< 0: no drop
};

/// Magnitude as logarithmic colour map with colour bar; direction as arrows; field zeros, coils, view, drop
/// and scale bar. Deterministic.
RgbImage draw_field(const FieldScene& scene);

}  // namespace faba
