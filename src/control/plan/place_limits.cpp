#include "control/plan/place_limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace faba {

PlaceLimits::PlaceLimits(const ControlContext& c, double margin, double clearance,
                         std::vector<Polygon> obstacles)
    : frame_(c.frame),
      drop_(c.drop),
      m_per_px_(c.scale.m_per_px),
      margin_(margin),
      clearance_(clearance),
      obstacles_(std::move(obstacles)) {
  const double half = m_per_px_ * std::min(frame_.width, frame_.height) / 2.0;
  const double room = drop_ ? std::min(half, drop_->radius) : half;
  if (margin < room) return;
  throw Error(
      Errc::usage, "controller.margin_px",
      fmt::format("{:g} px leaves no room for the swarm; it must be less than {:.4g} px, {}; reduce it",
                  margin / m_per_px_, room / m_per_px_,
                  room < half ? "the radius of the drop" : "half of the view"));
}

std::vector<PlaceLimit> PlaceLimits::near(Vec2 at) const {
  const Vec2 a = frame_.world_from_image({0, 0});
  const Vec2 b = frame_.world_from_image({double(frame_.width - 1), double(frame_.height - 1)});
  std::vector<PlaceLimit> limits{{PlanLimit::view, {1, 0}, std::max(a.x, b.x) - at.x - margin_},
                                 {PlanLimit::view, {-1, 0}, at.x - std::min(a.x, b.x) - margin_},
                                 {PlanLimit::view, {0, 1}, std::max(a.y, b.y) - at.y - margin_},
                                 {PlanLimit::view, {0, -1}, at.y - std::min(a.y, b.y) - margin_}};
  if (drop_) {
    const Vec2 out = at - drop_->centre;
    const double distance = norm(out), allowed = drop_->radius - margin_;
    // Near the centre the edge has no direction, and is not needed.
    if (distance > allowed / 2) limits.push_back({PlanLimit::drop, (1 / distance) * out, allowed - distance});
  }
  for (const Polygon& polygon : obstacles_) {
    const NearestEdge edge = nearest_edge(polygon, at);
    limits.push_back({PlanLimit::obstacle, -1.0 * edge.outward, edge.distance - clearance_});
  }
  return limits;
}

std::vector<std::string> PlaceLimits::notes(std::span<const Vec2> setpoints) const {
  constexpr std::size_t kListed = 50;  // more are a curve, of which one point is enough
  std::vector<std::string> notes;
  for (const Vec2 at : setpoints) {
    const std::vector<PlaceLimit> limits = near(at);
    const auto least =
        std::min_element(limits.begin(), limits.end(),
                         [](const PlaceLimit& a, const PlaceLimit& b) { return a.room < b.room; });
    const bool obstacle = least->limit == PlanLimit::obstacle;
    // Every run has a note on a setpoint outside of the view or the drop.
    if (least->room > -1e-3 * m_per_px_ || (!obstacle && least->room < -margin_)) continue;
    const Vec2 px = frame_.image_from_world(at);
    notes.push_back(fmt::format(
        "the plan keeps the swarm away from {}, and stops it {:.3g} px before the setpoint ({:g}, {:g}) px; "
        "move the setpoint, or reduce {}",
        obstacle ? "an obstacle" : "the edge", -least->room / m_per_px_, px.x, px.y,
        obstacle ? "the obstacle or clearance_px" : "margin_px"));
    if (setpoints.size() > kListed) break;
  }
  return notes;
}

}  // namespace faba
