#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "vision/draw/disc_sprites.h"
#include "vision/image/image.h"

namespace faba {

/// Content of a picture of a swarm at one time. All positions in picture px, y down.
struct SwarmScene {
  struct Cell {
    float x, y;
    std::uint8_t swarm;  ///< index of the population; selects the colour
    bool responding;     ///< false: drawn pale
  };
  int width = 640, height = 480;
  std::optional<double> um_per_px = 1;  ///< for the scale bar; empty: in px
  double t = 0;                         ///< s
  std::span<const Cell> cells;
  double cell_radius_px = 1.2;
  Vec2 edge_centre;
  double edge_radius_px = 0;                     ///< 0: no round edge, the picture border is the wall
  std::optional<Vec2> centroid;                  ///< green cross
  std::optional<Vec2> setpoint;                  ///< purple cross
  std::optional<Vec2> second_setpoint;           ///< of a second swarm; purple cross
  std::span<const Vec2> route;                   ///< thin purple line through all setpoints
  std::span<const std::vector<Vec2>> obstacles;  ///< polygons, red-orange
  Vec2 field_ut;                      ///< arrow in the corner: field at the centroid, world frame (y up), uT
  const Gray8* background = nullptr;  ///< background picture of the same size, drawn faintly; nullptr: none
};

/// Draws pictures of a swarm. Deterministic.
class SwarmPicture {
 public:
  /// Draws the part that all pictures have in common: background, drop with edge, obstacles, route.
  explicit SwarmPicture(const SwarmScene& scene);
  /// Draws the cells, crosses, scale bar, time and field arrow of `scene` on it. `picture` gets the result; a
  /// picture of this size is drawn without taking new memory.
  void draw(const SwarmScene& scene, RgbImage& picture) const;

 private:
  void draw_cells(const SwarmScene& scene, RgbImage& picture) const;

  RgbImage ground_;
  DiscSprites disc_;
};

}  // namespace faba
