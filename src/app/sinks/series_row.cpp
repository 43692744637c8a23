#include "app/sinks/series_row.h"

#include <fmt/format.h>

#include <cmath>

namespace faba {

std::vector<std::string> SeriesRow::names() const {
  std::vector<std::string> names{
      "frame",         "t_s",           "centroid_x_px", "centroid_y_px",    "sigma_x_px",    "sigma_y_px",
      "rms_radius_px", "distance_px",   "visible_count", "responding_count", "estimate_x_px", "estimate_y_px",
      "setpoint_x_px", "setpoint_y_px", "field_x_ut",    "field_y_ut"};
  for (std::size_t k = 0; k < c_.world->parts().field->coils(); ++k)
    names.push_back(fmt::format("current_{}_a", k));
  names.emplace_back("limited");
  return names;
}

std::vector<double> SeriesRow::values(const Tick& t) const {
  const State& s = c_.world->state();
  const auto x = s.agents["x"], y = s.agents["y"];
  const auto n = double(x.size());
  double sx = 0, sy = 0, visible = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += double(x[i]), sy += double(y[i]);
    visible += c_.frame.in_view(c_.frame.image_from_world({double(x[i]), double(y[i])}));
  }
  const Vec2 mean{sx / n, sy / n};
  double xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = double(x[i]) - mean.x, dy = double(y[i]) - mean.y;
    xx += dx * dx, yy += dy * dy;
  }
  const double px = 1 / c_.scale.m_per_px, divisor = n > 1 ? n - 1 : 1;
  const double sigma_x = std::sqrt(xx / divisor) * px, sigma_y = std::sqrt(yy / divisor) * px;
  const Vec2 at = c_.frame.image_from_world(mean), to = c_.frame.image_from_world(t.target.position);
  const Vec2 believed = c_.frame.image_from_world(t.estimate.centroid);
  const Vec3 b = c_.world->parts().field->at({mean.x, mean.y, 0}, s.current);
  std::vector<double> row{double(t.index),
                          c_.time_of(t.index),
                          at.x,
                          at.y,
                          sigma_x,
                          sigma_y,
                          std::sqrt(sigma_x * sigma_x + sigma_y * sigma_y),
                          norm(at - to),
                          visible,
                          double(c_.world->responding()),
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
