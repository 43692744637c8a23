#include "app/sinks/series_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace faba {
namespace {

using Cycle = SeriesCycle;

double px(const Cycle& m, double metres) { return metres * (1 / m.run.scale.m_per_px); }
Vec2 in_picture(const Cycle& m, Vec2 world) { return m.run.frame.image_from_world(world); }

double rms_radius(const Cycle& m) {
  const double x = px(m, m.truth.sigma_x), y = px(m, m.truth.sigma_y);
  return std::sqrt(x * x + y * y);
}

double distance(const Cycle& m) {
  return norm(in_picture(m, m.best().centroid) - in_picture(m, m.tick.target.position));
}

// Field at the swarm's centroid, of the actual currents in a simulation and of the commanded currents on a
// bench.
Vec3 field_ut(const Cycle& m) {
  const Vec2 at = m.best().centroid;
  const auto& current = m.run.truth ? m.run.truth->state().current : m.tick.command.current;
  return 1e6 * m.run.field->at({at.x, at.y, 0}, current);
}

constexpr bool kTruth = true, kAlways = false;

SeriesColumn current_column(const std::string& coil, std::function<double(const Cycle&)> value) {
  return {fmt::format("current_{}_a", coil), "A",
          fmt::format("commanded current of coil {}, after [limits]", coil), kAlways, std::move(value)};
}

// To add a column: insert its line in the order of the file, then generate the documentation with `make
// docs`.
std::vector<SeriesColumn> columns_around(std::vector<SeriesColumn> currents) {
  std::vector<SeriesColumn> all{
      {"frame", "", "number of the control cycle, from 0", kAlways,
       [](const Cycle& m) { return double(m.tick.index); }},
      {"t_s", "s", "time of the frame taken in this cycle: frame / rate, or its true time with camera.jitter",
       kAlways, [](const Cycle& m) { return m.run.frames->time_of(m.tick); }},
      {"true_centroid_x_px", "px", "mean position of all cells, in view or not, without camera delay", kTruth,
       [](const Cycle& m) { return in_picture(m, m.truth.centroid).x; }},
      {"true_centroid_y_px", "px", "likewise, y down", kTruth,
       [](const Cycle& m) { return in_picture(m, m.truth.centroid).y; }},
      {"true_sigma_x_px", "px", "standard deviation of the positions of all cells (divisor n - 1)", kTruth,
       [](const Cycle& m) { return px(m, m.truth.sigma_x); }},
      {"true_sigma_y_px", "px", "likewise in y", kTruth,
       [](const Cycle& m) { return px(m, m.truth.sigma_y); }},
      {"true_rms_radius_px", "px", "square root of the sum of both variances", kTruth, rms_radius},
      {"estimated_centroid_x_px", "px",
       "centroid of the estimator, with camera delay; the last one while no swarm is detected", kAlways,
       [](const Cycle& m) { return in_picture(m, m.estimated.centroid).x; }},
      {"estimated_centroid_y_px", "px", "likewise, y down", kAlways,
       [](const Cycle& m) { return in_picture(m, m.estimated.centroid).y; }},
      {"estimated_sigma_x_px", "px", "standard deviation of the estimator; empty while no swarm is detected",
       kAlways, [](const Cycle& m) { return px(m, m.estimated.sigma_x); }},
      {"estimated_sigma_y_px", "px", "likewise in y", kAlways,
       [](const Cycle& m) { return px(m, m.estimated.sigma_y); }},
      {"distance_px", "px",
       "distance from the swarm's centroid (true in a simulation, estimated on a bench; distance_source in "
       "manifest.json) to the setpoint; empty without a setpoint",
       kAlways, distance},
      {"visible_count", "", "number of cells in view: true in a simulation, estimated on a bench", kAlways,
       [](const Cycle& m) { return m.best().visible; }},
      {"responding_count", "", "number of cells that respond to the field", kTruth,
       [](const Cycle& m) { return m.truth.responding; }},
      {"setpoint_x_px", "px", "setpoint; empty without a setpoint", kAlways,
       [](const Cycle& m) { return in_picture(m, m.tick.target.position).x; }},
      {"setpoint_y_px", "px", "likewise, y down", kAlways,
       [](const Cycle& m) { return in_picture(m, m.tick.target.position).y; }},
      {"field_x_ut", "uT", "field at the swarm's centroid, world frame", kAlways,
       [](const Cycle& m) { return field_ut(m).x; }},
      {"field_y_ut", "uT", "likewise, y up", kAlways, [](const Cycle& m) { return field_ut(m).y; }}};
  std::move(currents.begin(), currents.end(), std::back_inserter(all));
  all.push_back({"limited", "", "1 if [limits] changed the command, otherwise 0", kAlways,
                 [](const Cycle& m) { return m.tick.limited ? 1.0 : 0.0; }});
  return all;
}

}  // namespace

std::vector<SeriesColumn> series_columns(std::size_t coils) {
  std::vector<SeriesColumn> currents;
  for (std::size_t k = 0; k < coils; ++k)
    currents.push_back(
        current_column(std::to_string(k), [k](const Cycle& m) { return m.tick.command.current[k]; }));
  return columns_around(std::move(currents));
}

std::vector<SeriesColumn> described_series_columns() { return columns_around({current_column("K", {})}); }

}  // namespace faba
