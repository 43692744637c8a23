#include "app/sinks/drawn_swarm.h"

#include <cmath>

#include "control/obstacles_px.h"
#include "control/two_swarms.h"

namespace faba {

DrawnSwarm::DrawnSwarm(const World& world, const Loop& loop, std::optional<double> um_per_px)
    : world_(world), loop_(loop), um_per_px_(um_per_px) {}

void DrawnSwarm::draw(double t, Vec2 target, RgbImage& picture) {
  const State& s = world_.state();
  const Frame& frame = world_.parts().arena->frame();
  const auto x = s.agents["x"], y = s.agents["y"], response = s.agents["response"];
  const auto& populations = world_.parts().populations;
  cells_.clear();
  double sx = 0, sy = 0;
  for (std::size_t k = 0; k < populations.size(); ++k)
    for (std::size_t i = populations[k].begin; i < populations[k].end; ++i) {
      sx += double(x[i]);
      sy += double(y[i]);
      const Vec2 p = frame.image_from_world({double(x[i]), double(y[i])});
      cells_.push_back({float(p.x), float(p.y), std::uint8_t(k), response[i] != 0.0f});
    }
  const Vec2 mean{sx / double(x.size()), sy / double(x.size())};
  const Vec3 b = world_.parts().field->at({mean.x, mean.y, 0}, s.current);
  const Outline edge = world_.parts().arena->outline();
  SwarmScene scene;
  scene.width = frame.width;
  scene.height = frame.height;
  scene.um_per_px = um_per_px_;
  scene.t = t;
  scene.cells = cells_;
  scene.edge_centre = edge.centre_image;
  scene.edge_radius_px = edge.radius_px;
  scene.centroid = frame.image_from_world(mean);
  if (std::isfinite(target.x)) scene.setpoint = frame.image_from_world(target);
  route_.clear();
  for (const Vec2 p : loop_.reference->setpoints()) route_.push_back(frame.image_from_world(p));
  scene.route = route_;
  const auto* two = dynamic_cast<const TwoSwarmController*>(loop_.controller);
  if (const auto second = two != nullptr ? two->second_setpoint() : std::nullopt)
    scene.second_setpoint = frame.image_from_world(*second);
  std::vector<std::vector<Vec2>> obstacles;
  if (!picture_) obstacles = obstacles_px(*loop_.controller, frame);  // drawn once
  scene.obstacles = obstacles;
  scene.field_ut = {b.x * 1e6, b.y * 1e6};
  if (!picture_) picture_.emplace(scene);
  picture_->draw(scene, picture);
}

}  // namespace faba
