#include "app/sinks/series_row.h"

#include <fmt/format.h>

#include <cmath>

namespace faba {
namespace {

/// Where the swarm is, m, world: of all cells where a simulation knows them, of the estimate on a bench.
struct Whereabouts {
  Vec2 mean;
  double sigma_x = 0, sigma_y = 0;
  double visible = 0, responding = std::nan("");
};

Whereabouts of_cells(const World& world, const Frame& frame) {
  const auto x = world.state().agents["x"], y = world.state().agents["y"];
  const auto n = double(x.size());
  Whereabouts w;
  double sx = 0, sy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += double(x[i]), sy += double(y[i]);
    w.visible += frame.in_view(frame.image_from_world({double(x[i]), double(y[i])}));
  }
  w.mean = {sx / n, sy / n};
  double xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = double(x[i]) - w.mean.x, dy = double(y[i]) - w.mean.y;
    xx += dx * dx, yy += dy * dy;
  }
  const double divisor = n > 1 ? n - 1 : 1;
  w.sigma_x = std::sqrt(xx / divisor), w.sigma_y = std::sqrt(yy / divisor);
  w.responding = double(world.responding());
  return w;
}

Whereabouts of_estimate(const Estimate& e) {
  const double nowhere = e.visible > 0 ? 0 : std::nan("");
  return {e.centroid, std::sqrt(std::max(0.0, e.cov.xx)) + nowhere,
          std::sqrt(std::max(0.0, e.cov.yy)) + nowhere, e.visible};
}

}  // namespace

std::vector<std::string> SeriesRow::names() const {
  std::vector<std::string> names{
      "frame",         "t_s",           "centroid_x_px", "centroid_y_px",    "sigma_x_px",    "sigma_y_px",
      "rms_radius_px", "distance_px",   "visible_count", "responding_count", "estimate_x_px", "estimate_y_px",
      "setpoint_x_px", "setpoint_y_px", "field_x_ut",    "field_y_ut"};
  for (std::size_t k = 0; k < c_.field->coils(); ++k) names.push_back(fmt::format("current_{}_a", k));
  names.emplace_back("limited");
  return names;
}

std::vector<double> SeriesRow::values(const Tick& t) const {
  const Whereabouts w = c_.world ? of_cells(*c_.world, c_.frame) : of_estimate(t.estimate);
  const double px = 1 / c_.scale.m_per_px;
  const double sigma_x = w.sigma_x * px, sigma_y = w.sigma_y * px;
  const Vec2 at = c_.frame.image_from_world(w.mean), to = c_.frame.image_from_world(t.target.position);
  const Vec2 believed = c_.frame.image_from_world(t.estimate.centroid);
  const Vec3 b =
      c_.field->at({w.mean.x, w.mean.y, 0}, c_.world ? c_.world->state().current : t.command.current);
  std::vector<double> row{double(t.index),
                          c_.time_of(t),
                          at.x,
                          at.y,
                          sigma_x,
                          sigma_y,
                          std::sqrt(sigma_x * sigma_x + sigma_y * sigma_y),
                          norm(at - to),
                          w.visible,
                          w.responding,
                          believed.x,
                          believed.y,
                          to.x,
                          to.y,
                          b.x * 1e6,
                          b.y * 1e6};
  row.insert(row.end(), t.command.current.begin(), t.command.current.end());
  row.push_back(t.limited ? 1 : 0);
  return row;
}

}  // namespace faba
