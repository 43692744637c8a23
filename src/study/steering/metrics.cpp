#include "study/steering/metrics.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/toml.h"
#include "core/vec.h"
#include "study/stats/statistics.h"
#include "study/steering/polyline.h"

namespace faba {
namespace {

using Values = std::span<const double>;

constexpr double kBandFraction = 0.05;
constexpr double kBandFloorPx = 10;
constexpr double kQuantile = 0.95;

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}
bool finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

struct Timed {
  double t, d;
};

std::vector<Vec2> points(Values xs, Values ys) {
  std::vector<Vec2> out(std::min(xs.size(), ys.size()));
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = {xs[k], ys[k]};
  return out;
}

void check_times(const Series& s, Values t) {
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (!std::isfinite(t[k])) throw Error(Errc::input, s.location(k), "t_s has no value");
    if (k > 0 && t[k] <= t[k - 1]) {
      throw Error(Errc::input, s.location(k),
                  fmt::format("t_s decreases or repeats ({} after {}); it must increase", t[k], t[k - 1]));
    }
  }
}

/// The setpoints in order, and the first row of each.
struct Route {
  std::vector<Vec2> vertex;
  std::vector<std::size_t> since;
};

Route route_of(const std::vector<Vec2>& setpoint) {
  Route route;
  for (std::size_t k = 0; k < setpoint.size(); ++k) {
    if (!finite(setpoint[k]) || (!route.vertex.empty() && route.vertex.back() == setpoint[k])) continue;
    route.vertex.push_back(setpoint[k]);
    route.since.push_back(k);
  }
  return route;
}

std::optional<double> settling_time(const std::vector<Timed>& targeted, double band) {
  if (targeted.back().d > band) return std::nullopt;
  std::size_t entry = targeted.size() - 1;
  while (entry > 0 && targeted[entry - 1].d <= band) --entry;
  return targeted[entry].t - targeted.front().t;
}

/// Time at which the distance first falls to `level`, interpolated between frames.
std::optional<double> first_fall(const std::vector<Timed>& leg, double level) {
  for (std::size_t k = 1; k < leg.size(); ++k) {
    if (leg[k].d > level) continue;
    const Timed a = leg[k - 1], b = leg[k];
    return a.t + (b.t - a.t) * (a.d - level) / (a.d - b.d);
  }
  return std::nullopt;
}

void measure_error(Metrics& m, Values t, Values d, std::size_t first_leg_end) {
  std::vector<Timed> targeted, first_leg;
  for (std::size_t k = 0; k < d.size(); ++k) {
    if (!std::isfinite(d[k])) continue;
    targeted.push_back({t[k], d[k]});
    if (k < first_leg_end) first_leg.push_back({t[k], d[k]});
  }
  if (targeted.empty()) return;
  const auto [t0, d0] = targeted.front();
  m.initial_error_px = d0;
  m.final_distance_px = targeted.back().d;
  m.settling_band_px = std::max(kBandFraction * d0, kBandFloorPx);
  m.settling_time_s = settling_time(targeted, *m.settling_band_px);
  if (d0 > kBandFloorPx) {
    const auto from = first_fall(first_leg, 0.9 * d0), to = first_fall(first_leg, 0.1 * d0);
    if (from && to) m.rise_time_s = *to - *from;
  }

  double square = 0;
  std::size_t count = 0;
  for (std::size_t k = 2 * d.size() / 3; k < d.size(); ++k) {
    if (std::isfinite(d[k])) {
      square += d[k] * d[k];
      m.steady_max_px = std::max(m.steady_max_px.value_or(0), d[k]);
      ++count;
    }
  }
  if (count > 0) m.steady_rms_px = std::sqrt(square / double(count));

  for (std::size_t k = 1; k < d.size(); ++k) {
    if (!std::isfinite(d[k - 1]) || !std::isfinite(d[k])) continue;
    const double half = 0.5 * (t[k] - t[k - 1]);
    m.iae_px_s = m.iae_px_s.value_or(0) + half * (d[k - 1] + d[k]);
    m.itae_px_s2 = m.itae_px_s2.value_or(0) + half * ((t[k - 1] - t0) * d[k - 1] + (t[k] - t0) * d[k]);
  }
}

/// Number of legs with a distance of at most `tolerance` in some frame.
std::size_t reached(Values d, const std::vector<std::size_t>& since, double tolerance) {
  std::size_t count = 0;
  for (std::size_t leg = 0; leg < since.size(); ++leg) {
    const std::size_t end = leg + 1 < since.size() ? since[leg + 1] : d.size();
    const Values of_leg = d.subspan(since[leg], end - since[leg]);
    count +=
        std::any_of(of_leg.begin(), of_leg.end(), [&](double x) { return x <= tolerance; });  // false for NaN
  }
  return count;
}

std::optional<double> overshoot_percent(const std::vector<Vec2>& centroid, const Route& route,
                                        std::size_t leg_end) {
  std::size_t first = route.since.front();
  while (first < leg_end && !finite(centroid[first])) ++first;
  if (first + 1 >= leg_end) return std::nullopt;
  const Vec2 line = route.vertex.front() - centroid[first];
  const double length = norm(line);
  if (length <= kBandFloorPx) return std::nullopt;
  double furthest = 0;
  for (std::size_t k = first; k < leg_end; ++k) {
    const double progress = dot(centroid[k] - centroid[first], line) / (length * length);
    if (progress > furthest) furthest = progress;  // false for NaN
  }
  return 100 * std::max(0.0, furthest - 1);
}

void measure_route(Metrics& m, const std::vector<Vec2>& centroid, const Route& route) {
  if (route.vertex.size() < 2) return;
  const Polyline polyline(route.vertex);
  std::vector<double> error;
  double square = 0;
  for (std::size_t k = route.since[1]; k < centroid.size(); ++k) {
    if (!finite(centroid[k])) continue;
    error.push_back(polyline.distance(centroid[k]));
    square += error.back() * error.back();
  }
  if (error.empty()) return;
  m.cross_track_rms_px = std::sqrt(square / double(error.size()));
  m.cross_track_95_px = quantile(std::move(error), kQuantile);
}

std::optional<double> polyline_length(const std::vector<Vec2>& at) {
  std::optional<double> sum;
  for (std::size_t k = 1; k < at.size(); ++k) {
    if (finite(at[k - 1]) && finite(at[k])) sum = sum.value_or(0) + norm(at[k] - at[k - 1]);
  }
  return sum;
}

void measure_command(Metrics& m, const Series& series, Values t) {
  for (std::size_t coil = 0;; ++coil) {
    const Values current = series.find(fmt::format("current_{}_a", coil));
    if (current.empty()) break;
    double effort = m.control_effort_a2_s.value_or(0), variation = m.total_variation_a.value_or(0);
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      if (!std::isfinite(current[k])) continue;
      effort += current[k] * current[k] * (t[k + 1] - t[k]);
      if (std::isfinite(current[k + 1])) variation += std::abs(current[k + 1] - current[k]);
    }
    m.control_effort_a2_s = effort;
    m.total_variation_a = variation;
  }
  m.total_variation_ut = polyline_length(points(series.find("field_x_ut"), series.find("field_y_ut")));

  std::size_t known = 0, limited = 0;
  for (const double value : series.find("limited")) {
    known += std::isfinite(value);
    limited += std::isfinite(value) && value != 0;
  }
  if (known > 0) m.limited_fraction = double(limited) / double(known);
}

}  // namespace

Metrics control_metrics(const Series& series, std::optional<double> tolerance_px,
                        std::size_t given_setpoints) {
  const Values t = series.column("t_s"), d = series.column("distance_px");
  const SwarmColumns swarm = swarm_columns(series);
  check_times(series, t);

  Metrics m;
  m.source = swarm.source;
  m.frames = series.size();
  if (m.frames == 0) return m;
  m.duration_s = t.back() - t.front();
  const std::vector<Vec2> centroid = points(swarm.x, swarm.y);
  const Route route = route_of(points(series.find("setpoint_x_px"), series.find("setpoint_y_px")));
  const std::size_t first_leg_end = route.since.size() > 1 ? route.since[1] : m.frames;

  measure_error(m, t, d, first_leg_end);
  m.setpoints = route.vertex.size();
  if (m.setpoints == 0 && m.initial_error_px) m.setpoints = 1;  // older recordings have the distance only
  m.given_setpoints = std::max(m.setpoints, given_setpoints);
  if (m.route_unfinished()) m.settling_time_s.reset();
  if (m.initial_error_px) {
    const std::vector<std::size_t> since = route.since.empty() ? std::vector<std::size_t>{0} : route.since;
    m.setpoints_reached = double(reached(d, since, tolerance_px.value_or(*m.settling_band_px)));
  }
  if (!route.vertex.empty()) m.overshoot_percent = overshoot_percent(centroid, route, first_leg_end);
  m.path_length_px = polyline_length(centroid);
  measure_route(m, centroid, route);
  m.sigma_x_px = finite(swarm.sigma_x.back());
  m.sigma_y_px = finite(swarm.sigma_y.back());
  m.rms_radius_px = finite(swarm.rms_radius.back());
  m.initial_rms_radius_px = finite(swarm.rms_radius.front());
  if (const Values visible = series.find("visible_count"); !visible.empty()) {
    m.visible_at_end = finite(visible.back());
    m.most_visible = finite(*std::max_element(visible.begin(), visible.end()));
  }
  measure_command(m, series, t);
  return m;
}

}  // namespace faba
