#include "app/sinks/series_row.h"

#include <cmath>
#include <limits>

namespace faba {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

SwarmState truth_of(const World& world, const Frame& frame) {
  const auto x = world.state().agents["x"], y = world.state().agents["y"];
  const auto n = double(x.size());
  SwarmState s;
  double sum_x = 0, sum_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum_x += double(x[i]);
    sum_y += double(y[i]);
    s.visible += frame.in_view(frame.image_from_world({double(x[i]), double(y[i])}));
  }
  s.centroid = {sum_x / n, sum_y / n};
  double xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = double(x[i]) - s.centroid.x, dy = double(y[i]) - s.centroid.y;
    xx += dx * dx;
    yy += dy * dy;
  }
  const double divisor = n > 1 ? n - 1 : 1;
  s.sigma_x = std::sqrt(xx / divisor);
  s.sigma_y = std::sqrt(yy / divisor);
  s.responding = double(world.responding());
  return s;
}

SwarmState estimate_of(const Estimate& e) {
  const bool seen = e.visible > 0;
  return {.centroid = e.centroid,
          .sigma_x = seen ? std::sqrt(std::max(0.0, e.cov.xx)) : kNone,
          .sigma_y = seen ? std::sqrt(std::max(0.0, e.cov.yy)) : kNone,
          .visible = e.visible,
          .responding = kNone};
}

}  // namespace

SeriesRow::SeriesRow(SinkContext c) : c_(std::move(c)), columns_(series_columns(c_.field->coils())) {
  if (!c_.truth) std::erase_if(columns_, [](const SeriesColumn& column) { return column.simulated_only; });
}

std::vector<std::string> SeriesRow::names() const {
  std::vector<std::string> names;
  for (const SeriesColumn& column : columns_) names.push_back(column.name);
  return names;
}

std::vector<double> SeriesRow::values(const Tick& t) const {
  const SeriesCycle m{.tick = t,
                      .run = c_,
                      .truth = c_.truth ? truth_of(*c_.truth, c_.frame) : SwarmState{},
                      .estimated = estimate_of(t.estimate)};
  std::vector<double> row;
  row.reserve(columns_.size());
  for (const SeriesColumn& column : columns_) row.push_back(column.value(m));
  return row;
}

}  // namespace faba
