#pragma once
#include "app/run/simulation.h"
#include "vision/draw/swarm_picture.h"

namespace faba {

/// Draws a simulation as a picture for people: cells in the colours of their swarms, the drop, setpoint and
/// route, the field at the centroid. What does not change is drawn once.
class DrawnSwarm {
 public:
  /// Both outlive it. `um_per_px` for the scale bar.
  DrawnSwarm(const World& world, const Loop& loop, double um_per_px);
  /// `target`: where the swarm is wanted, in the world; not finite: nowhere.
  RgbImage draw(double t, Vec2 target);

 private:
  const World& world_;
  const Loop& loop_;
  double um_per_px_;
  std::vector<Vec2> route_;
  std::vector<SwarmScene::Cell> cells_;
  RgbImage ground_;
};

}  // namespace faba
