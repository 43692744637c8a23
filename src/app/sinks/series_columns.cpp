#include "app/sinks/series_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace faba {
namespace {

using Moment = SeriesMoment;

double px(const Moment& m, double metres) { return metres * (1 / m.run.scale.m_per_px); }
Vec2 in_picture(const Moment& m, Vec2 world) { return m.run.frame.image_from_world(world); }

double rms_radius(const Moment& m) {
  const double x = px(m, m.truth.sigma_x), y = px(m, m.truth.sigma_y);
  return std::sqrt(x * x + y * y);
}

double distance(const Moment& m) {
  return norm(in_picture(m, m.best().centroid) - in_picture(m, m.tick.target.position));
}

// At the swarm's centroid, by the currents that flow in a simulation and those that are commanded on a bench.
Vec3 field_ut(const Moment& m) {
  const Vec2 at = m.best().centroid;
  const auto& current = m.run.truth ? m.run.truth->state().current : m.tick.command.current;
  return 1e6 * m.run.field->at({at.x, at.y, 0}, current);
}

constexpr bool kTruth = true, kAlways = false;

SeriesColumn current_column(const std::string& coil, std::function<double(const Moment&)> value) {
  return {fmt::format("current_{}_a", coil), "A",
          fmt::format("commanded current of coil {}, after [limits]", coil), kAlways, std::move(value)};
}

// To add a column: insert its line at its place in the order, then generate the documentation with `make
// docs`.
std::vector<SeriesColumn> columns_around(std::vector<SeriesColumn> currents) {
  std::vector<SeriesColumn> all{
      {"frame", "", "number of the turn of the control loop, from 0", kAlways,
       [](const Moment& m) { return double(m.tick.index); }},
      {"t_s", "s",
       "time of the frame that was taken in this turn: frame / rate, or its true time with camera.jitter",
       kAlways, [](const Moment& m) { return m.run.frames->time_of(m.tick); }},
      {"true_centroid_x_px", "px", "mean position of all cells, in view or not, without the camera's delay",
       kTruth, [](const Moment& m) { return in_picture(m, m.truth.centroid).x; }},
      {"true_centroid_y_px", "px", "likewise, y down", kTruth,
       [](const Moment& m) { return in_picture(m, m.truth.centroid).y; }},
      {"true_sigma_x_px", "px", "standard deviation of the positions of all cells (divisor n - 1)", kTruth,
       [](const Moment& m) { return px(m, m.truth.sigma_x); }},
      {"true_sigma_y_px", "px", "likewise in y", kTruth,
       [](const Moment& m) { return px(m, m.truth.sigma_y); }},
      {"true_rms_radius_px", "px", "root of the sum of both variances", kTruth, rms_radius},
      {"estimated_centroid_x_px", "px",
       "the estimator's centroid, camera delay included; the last one while nothing is seen", kAlways,
       [](const Moment& m) { return in_picture(m, m.estimated.centroid).x; }},
      {"estimated_centroid_y_px", "px", "likewise, y down", kAlways,
       [](const Moment& m) { return in_picture(m, m.estimated.centroid).y; }},
      {"estimated_sigma_x_px", "px", "the estimator's standard deviation; empty while nothing is seen",
       kAlways, [](const Moment& m) { return px(m, m.estimated.sigma_x); }},
      {"estimated_sigma_y_px", "px", "likewise in y", kAlways,
       [](const Moment& m) { return px(m, m.estimated.sigma_y); }},
      {"distance_px", "px",
       "from the swarm's centroid to the setpoint: the true one in a simulation, the estimated one on a "
       "bench "
       "(distance_source in manifest.json); empty without a setpoint",
       kAlways, distance},
      {"visible_count", "", "cells in view: counted in a simulation, estimated on a bench", kAlways,
       [](const Moment& m) { return m.best().visible; }},
      {"responding_count", "", "cells that feel the field", kTruth,
       [](const Moment& m) { return m.truth.responding; }},
      {"setpoint_x_px", "px", "where the swarm should be; empty without a setpoint", kAlways,
       [](const Moment& m) { return in_picture(m, m.tick.target.position).x; }},
      {"setpoint_y_px", "px", "likewise, y down", kAlways,
       [](const Moment& m) { return in_picture(m, m.tick.target.position).y; }},
      {"field_x_ut", "uT", "field at the swarm's centroid, world frame", kAlways,
       [](const Moment& m) { return field_ut(m).x; }},
      {"field_y_ut", "uT", "likewise, y up", kAlways, [](const Moment& m) { return field_ut(m).y; }}};
  std::ranges::move(currents, std::back_inserter(all));
  all.push_back({"limited", "", "1 when [limits] changed the command, else 0", kAlways,
                 [](const Moment& m) { return m.tick.limited ? 1.0 : 0.0; }});
  return all;
}

}  // namespace

std::vector<SeriesColumn> series_columns(std::size_t coils) {
  std::vector<SeriesColumn> currents;
  for (std::size_t k = 0; k < coils; ++k)
    currents.push_back(
        current_column(std::to_string(k), [k](const Moment& m) { return m.tick.command.current[k]; }));
  return columns_around(std::move(currents));
}

std::vector<SeriesColumn> described_series_columns() { return columns_around({current_column("K", {})}); }

}  // namespace faba
