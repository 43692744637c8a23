#pragma once
#include <optional>
#include <span>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// What to draw of a swarm at one moment. All positions in picture px, y down.
struct SwarmScene {
  struct Cell {
    float x, y;
    std::uint8_t swarm;  ///< index of its population: its colour
    bool responding;     ///< others are drawn pale
  };
  int width = 640, height = 480;
  double um_per_px = 1;
  double t = 0;  ///< s
  std::span<const Cell> cells;
  double cell_radius_px = 1.2;
  Vec2 edge_centre;
  double edge_radius_px = 0;          ///< 0: no round edge, the picture's border is the wall
  std::optional<Vec2> centroid;       ///< green cross
  std::optional<Vec2> setpoint;       ///< purple cross
  std::span<const Vec2> route;        ///< thin purple line through all setpoints when there are several
  Vec2 field_ut;                      ///< arrow in the corner: field at the centroid, world frame (y up), uT
  const Gray8* background = nullptr;  ///< a real picture, drawn faintly; of the same size
};

/// What does not change from frame to frame: the ground, the drop with its edge, the route.
RgbImage draw_ground(const SwarmScene& scene);

/// The whole picture: dark cells, crosses, scale bar, clock and field arrow on a ground drawn before.
/// Same scene, same pixels. Throws nothing.
RgbImage draw_swarm(const SwarmScene& scene, const RgbImage& ground);

}  // namespace faba
