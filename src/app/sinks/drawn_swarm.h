#pragma once
#include <optional>

#include "app/run/simulation.h"
#include "vision/draw/swarm_picture.h"

namespace faba {

/// Draws a simulation as a schematic picture: cells in the colours of their swarms, the drop, setpoints,
/// route and obstacles, the field at the centroid. The constant background is drawn once.
class DrawnSwarm {
 public:
  /// `world` and `loop` must outlive it. `um_per_px` is for the scale bar; empty: in px.
  DrawnSwarm(const World& world, const Loop& loop, std::optional<double> um_per_px);
  /// `target`: setpoint in world coordinates; not finite: none. `picture`: as for SwarmPicture::draw().
  void draw(double t, Vec2 target, RgbImage& picture);

 private:
  const World& world_;
  const Loop& loop_;
  std::optional<double> um_per_px_;
  std::vector<Vec2> route_;
  std::vector<SwarmScene::Cell> cells_;
  std::optional<SwarmPicture> picture_;
};

}  // namespace faba
