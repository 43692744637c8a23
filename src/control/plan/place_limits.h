#pragma once
#include <span>
#include <string>
#include <vector>

#include "control/controller.h"
#include "control/plan/obstacles.h"
#include "control/plan/plan.h"

namespace faba {

/// A limit of places at a position: the swarm may move by `room` (m) along `direction`.
struct PlaceLimit {
  PlanLimit limit;
  Vec2 direction;
  double room = 0;
};

/// Where a controller keeps the mean of a swarm: in the view and in the drop, and outside of obstacles.
class PlaceLimits {
 public:
  /// `margin`: distance from the edges, m; `clearance`: from the obstacles, m. Throws Error(usage) when the
  /// margin leaves no room.
  PlaceLimits(const ControlContext& c, double margin, double clearance, std::vector<Polygon> obstacles);
  const std::vector<Polygon>& obstacles() const { return obstacles_; }  ///< world, m
  std::vector<PlaceLimit> near(Vec2 at) const;
  /// Setpoints (world, m) from which the limits keep the swarm away, in sentences.
  std::vector<std::string> notes(std::span<const Vec2> setpoints) const;

 private:
  Frame frame_;
  std::optional<Disc> drop_;
  double m_per_px_, margin_, clearance_;
  std::vector<Polygon> obstacles_;
};

}  // namespace faba
