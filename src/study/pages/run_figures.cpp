#include "study/pages/run_figures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "control/plan/obstacles.h"
#include "study/plot/markup.h"

namespace faba {
namespace {

using Values = std::vector<double>;

Values values(std::span<const double> column) { return {column.begin(), column.end()}; }

bool has_number(std::span<const double> column) {
  return std::any_of(column.begin(), column.end(), [](double v) { return std::isfinite(v); });
}
bool varies(std::span<const double> column) {
  return std::any_of(column.begin(), column.end(),
                     [&](double v) { return std::isfinite(v) && v != column.front(); });
}

Plot over_time(std::string what, std::string description) {
  Plot plot;
  plot.x.label = "time (s)";
  plot.y.label = std::move(what);
  plot.description = std::move(description);
  plot.inlined = true;
  return plot;
}

/// Plot of a length over time: starts at zero, with a second axis in micrometres when the scale is known.
Plot lengths_over_time(const std::string& what, std::string description, const RunInfo& info) {
  Plot plot = over_time(what + " (px)", std::move(description));
  plot.y.lo = 0;
  if (info.um_per_px) plot.right = SecondScale{*info.um_per_px, what + " (µm)"};
  return plot;
}

/// Setpoints at their times of change, without repetitions.
struct Setpoints {
  Values t, x, y;
};

Setpoints setpoints_of(const Series& series) {
  Setpoints out;
  const auto t = series.column("t_s"), x = series.find("setpoint_x_px"), y = series.find("setpoint_y_px");
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    if (!out.t.empty() && out.x.back() == x[k] && out.y.back() == y[k]) continue;
    out.t.push_back(t[k]);
    out.x.push_back(x[k]);
    out.y.push_back(y[k]);
  }
  return out;
}

// Whether the centroid is estimated: a series without true columns has those of the estimator.
bool is_estimated(const Series& series) { return swarm_columns(series).source != "true"; }
const char* centroid_of(const Series& series) {
  return is_estimated(series) ? "estimated centroid" : "true centroid of all cells";
}

constexpr double kShortApproach = 0.1;  // fraction of the run; a shorter approach gets a separate figure
constexpr std::size_t kMaxSetpointMarks = 12;  // more setpoints are a moving target without marks

double first_targeted_time(const Series& series) {
  const auto t = series.column("t_s"), d = series.column("distance_px");
  std::size_t k = 0;
  while (k + 1 < d.size() && !std::isfinite(d[k])) ++k;
  return t[k];
}

Figure distance_figure(const Series& series, const Metrics& m, const RunInfo& info) {
  Figure figure{
      "Distance to the setpoint",
      fmt::format("Distance between the {} and the setpoint. The band is the larger of 5 % of the "
                  "initial error and 10 px; the swarm is settled after its last entry into the band{}.",
                  centroid_of(series),
                  m.route_unfinished() ? ", but this run ended before the last setpoint" : ""),
      lengths_over_time("distance", "Distance to the setpoint over time", info)};
  Plot& plot = figure.plot;
  const double band = m.settling_band_px.value_or(0);
  plot.add(Band{0, band, fmt::format("settling band, {} px", three_digits(band)), false, Ink::green});
  const Setpoints setpoints = setpoints_of(series);
  if (setpoints.t.size() > 1 && setpoints.t.size() <= kMaxSetpointMarks) {
    for (std::size_t i = 1; i < setpoints.t.size(); ++i) plot.add(Rule{setpoints.t[i]});
    figure.caption += " Grey lines: setpoint changes.";
  }
  plot.add(Line{values(series.column("t_s")), values(series.column("distance_px")), "distance"});
  if (m.settling_time_s) {
    plot.add(Rule{first_targeted_time(series) + *m.settling_time_s,
                  fmt::format("settled, {} s", three_digits(*m.settling_time_s)), true, Ink::text});
  }
  return figure;
}

/// The start of the distance figure, for a settling time that is a small part of the run.
Figure approach_figure(Figure figure, const Series& series, const Metrics& m) {
  const double begin = first_targeted_time(series);
  figure.heading = "Approach";
  figure.caption = "Start of Figure 1, enlarged.";
  figure.plot.description = "Distance to the setpoint at the start of the run";
  figure.plot.x.lo = begin;
  figure.plot.x.hi = begin + 3 * *m.settling_time_s;
  return figure;
}

Figure holding_figure(const Series& series, const Metrics& m, const RunInfo& info) {
  const auto t = series.column("t_s"), d = series.column("distance_px");
  const auto from = std::ptrdiff_t(2 * t.size() / 3);
  Figure figure{
      "Steady-state error", "Distance to the setpoint over the last third of the frames.",
      lengths_over_time("distance", "Distance to the setpoint over the last third of the run", info)};
  // With the band the axis shows how large the error is relative to the tolerance.
  const double band = m.settling_band_px.value_or(0);
  figure.plot.add(Band{0, band, fmt::format("settling band, {} px", three_digits(band)), false, Ink::green});
  figure.plot.add(Line{{t.begin() + from, t.end()}, {d.begin() + from, d.end()}, "distance"});
  figure.plot.add(Line{{t[std::size_t(from)], t.back()},
                       {*m.steady_rms_px, *m.steady_rms_px},
                       fmt::format("rms, {} px", three_digits(*m.steady_rms_px)),
                       Ink::text,
                       true});
  return figure;
}

/// Sets the axis ranges to the picture, when known, and the complete path with all setpoints.
void set_path_range(Plot& plot, const Series& series, const RunInfo& info, const Setpoints& setpoints) {
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
  const auto take = [&](double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    y0 = std::min(y0, y);
    y1 = std::max(y1, y);
  };
  const SwarmColumns swarm = swarm_columns(series);
  for (std::size_t k = 0; k < swarm.x.size(); ++k) take(swarm.x[k], swarm.y[k]);
  for (std::size_t i = 0; i < setpoints.x.size(); ++i) take(setpoints.x[i], setpoints.y[i]);
  if (info.view_px) {
    take(-0.5, -0.5);
    take(info.view_px->x - 0.5, info.view_px->y - 0.5);
  }
  if (x0 > x1) return;
  const double margin = info.view_px ? 0.015 * (x1 - x0) : std::max(5.0, 0.08 * std::max(x1 - x0, y1 - y0));
  plot.x.lo = x0 - margin;
  plot.x.hi = x1 + margin;
  plot.y.lo = y0 - margin;
  plot.y.hi = y1 + margin;
}

void add_outlines(Plot& plot, const RunInfo& info) {
  const Box picture =
      info.view_px ? Box{-0.5, -0.5, info.view_px->x - 0.5, info.view_px->y - 0.5, "picture"} : Box{};
  Box walls;
  if (info.arena && info.arena->size_px) {
    const Vec2 centre = info.arena->centre_px, half = 0.5 * *info.arena->size_px;
    walls =
        Box{centre.x - half.x, centre.y - half.y, centre.x + half.x, centre.y + half.y, "walls", Ink::sky};
  }
  const double difference = std::max({std::abs(walls.x0 - picture.x0), std::abs(walls.x1 - picture.x1),
                                      std::abs(walls.y0 - picture.y0), std::abs(walls.y1 - picture.y1)});
  const bool same = !walls.label.empty() && difference < 1.5;  // px: draw one outline
  if (same) walls.label = "picture and walls";
  if (!picture.label.empty() && !same) plot.add(picture);
  if (!walls.label.empty()) plot.add(walls);
  if (info.arena && info.arena->radius_px) {
    const double radius = *info.arena->radius_px;
    plot.add(
        Ellipse{info.arena->centre_px.x, info.arena->centre_px.y, radius, radius, "drop edge", Ink::sky});
  }
}

void add_obstacles(Figure& figure, const Values& x, const Values& y, const RunInfo& info) {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t inside = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i] + y[i])) continue;
    double here = std::numeric_limits<double>::infinity();
    for (const std::vector<Vec2>& polygon : info.obstacles_px)
      here = std::min(here, nearest_edge(polygon, {x[i], y[i]}).distance);
    nearest = std::min(nearest, here);
    inside += here < 0;
  }
  for (const std::vector<Vec2>& polygon : info.obstacles_px) {
    Line edge{{}, {}, &polygon == &info.obstacles_px.front() ? "obstacle" : "", Ink::vermillion};
    for (std::size_t i = 0; i <= polygon.size(); ++i) {
      edge.x.push_back(polygon[i % polygon.size()].x);
      edge.y.push_back(polygon[i % polygon.size()].y);
    }
    figure.plot.add(edge);
  }
  if (inside > 0)
    figure.caption += fmt::format(" The path was inside an obstacle in {:.3g} % of the frames.",
                                  100.0 * double(inside) / double(x.size()));
  else if (std::isfinite(nearest))
    figure.caption += fmt::format(" Smallest distance of the path from an obstacle: {:.3g} px.", nearest);
}

Figure path_figure(const Series& series, const Metrics& m, const RunInfo& info) {
  const SwarmColumns swarm = swarm_columns(series);
  const auto x = swarm.x, y = swarm.y;
  Figure figure{"Path in the picture",
                fmt::format("Path of the {} in picture coordinates; y points down.", centroid_of(series)),
                {}};
  Plot& plot = figure.plot;
  plot.description = "Path of the centroid in the picture";
  plot.inlined = plot.equal_aspect = plot.y.reversed = true;
  plot.x.label = "x (px)";
  plot.y.label = "y (px)";
  if (!has_number(x)) return figure;  // without the path there is nothing to show
  const Setpoints setpoints = setpoints_of(series);
  set_path_range(plot, series, info, setpoints);
  add_outlines(plot, info);
  if (!info.obstacles_px.empty()) add_obstacles(figure, values(x), values(y), info);
  if (m.sigma_x_px && m.sigma_y_px && std::isfinite(x.back() + y.back())) {
    plot.add(Ellipse{x.back(), y.back(), *m.sigma_x_px, *m.sigma_y_px, "final standard deviation",
                     Ink::orange, true});
    figure.caption +=
        " Semi-axes of the dashed ellipse: standard deviations of the cell positions in the last frame.";
  }
  if (setpoints.x.size() > 1)
    plot.add(Line{setpoints.x, setpoints.y, "route", Ink::purple, true, false, 1.4});
  plot.add(Line{values(x), values(y), "centroid", Ink::blue});
  plot.add(Scatter{{x.front()}, {y.front()}, "start", Ink::blue, Scatter::Mark::ring, 9});
  plot.add(Scatter{{x.back()}, {y.back()}, "end", Ink::blue, Scatter::Mark::dot, 8});
  if (!setpoints.x.empty() && setpoints.x.size() <= kMaxSetpointMarks) {
    plot.add(Scatter{setpoints.x, setpoints.y, "setpoint", Ink::purple, Scatter::Mark::cross, 13});
  }
  return figure;
}

Figure dispersion_figure(const Series& series, const RunInfo& info) {
  const Values t = values(series.column("t_s"));
  Figure figure{
      "Dispersion",
      "Standard deviations of the cell positions in x and y, and root-mean-square distance of the cells from "
      "the centroid.",
      lengths_over_time("dispersion", "Dispersion of the swarm over time", info)};
  const SwarmColumns swarm = swarm_columns(series);
  figure.plot.add(Line{t, swarm.rms_radius, "rms radius", Ink::text});
  figure.plot.add(Line{t, values(swarm.sigma_x), "\u03C3x", Ink::blue});
  figure.plot.add(Line{t, values(swarm.sigma_y), "\u03C3y", Ink::vermillion, true});
  return figure;
}

constexpr int kMaxReversals = 100;    // of a signal that a plot can resolve
constexpr std::size_t kWindows = 60;  // of the mean and range of a faster signal

/// Whether a signal reverses more often than a plot can resolve; changes below 5 % of its range are ignored.
bool switches_too_fast(const Values& v) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const double x : v)
    if (std::isfinite(x)) {
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
  int reversals = 0, direction = 0;
  double extreme = v.empty() ? 0 : v.front();
  for (const double x : v) {
    if (!std::isfinite(x)) continue;
    if (std::abs(x - extreme) > 0.05 * (hi - lo)) {
      const int now = x > extreme ? 1 : -1;
      reversals += now != direction;
      direction = now;
      extreme = x;
    } else if ((x - extreme) * direction > 0) {
      extreme = x;
    }
  }
  return reversals > kMaxReversals;
}

/// Adds a command over time or, when it switches too fast, its mean and range in windows. Returns the length
/// of a window, s; 0 for none.
double add_command(Plot& plot, const Values& t, const Values& v, const Line& style) {
  if (t.size() < 2 * kWindows || !switches_too_fast(v)) {
    Line line = style;
    line.x = t;
    line.y = v;
    line.stairs = true;
    line.width = 1.4;
    plot.add(std::move(line));
    return 0;
  }
  const std::size_t size = (t.size() + kWindows - 1) / kWindows;
  Ribbon range{{}, {}, {}, {}, style.ink};
  Line mean = style;
  for (std::size_t first = 0; first < t.size(); first += size) {
    const std::size_t end = std::min(first + size, t.size());
    const auto [lo, hi] = std::minmax_element(&v[first], &v[first] + (end - first));
    range.x.push_back(0.5 * (t[first] + t[end - 1]));
    range.lo.push_back(*lo);
    range.hi.push_back(*hi);
    mean.y.push_back(std::accumulate(&v[first], &v[first] + (end - first), 0.0) / double(end - first));
  }
  mean.x = range.x;
  plot.add(std::move(range)).add(std::move(mean));
  return double(size) * (t.back() - t.front()) / double(t.size() - 1);
}

std::string window_note(double window) {
  if (window == 0) return {};
  return fmt::format(
      " The signal switches too fast to be resolved: lines are means over {} s, shaded areas the ranges in "
      "these windows.",
      three_digits(window));
}

Figure field_figure(const Series& series) {
  const Values t = values(series.column("t_s"));
  const Values x = values(series.find("field_x_ut")), y = values(series.find("field_y_ut"));
  Values size(x.size()), limited(x.size(), std::numeric_limits<double>::quiet_NaN());
  const auto clipped = series.find("limited");
  for (std::size_t k = 0; k < x.size(); ++k) {
    size[k] = std::sqrt(x[k] * x[k] + y[k] * y[k]);
    if (!clipped.empty() && clipped[k] != 0 && std::isfinite(clipped[k])) limited[k] = size[k];
  }
  Figure figure{"Magnetic field", "Field at the centroid, world frame: x to the right, y up.",
                over_time("field (µT)", "Magnetic field at the centroid over time")};
  if (has_number(limited)) {
    figure.plot.add(Line{t, limited, "limited", Ink::orange, false, true, 5});
    figure.caption += " Highlighted magnitude: the command was limited.";
  }
  double window = add_command(figure.plot, t, size, {{}, {}, "magnitude", Ink::text});
  window = std::max(window, add_command(figure.plot, t, x, {{}, {}, "Bx", Ink::blue}));
  window = std::max(window, add_command(figure.plot, t, y, {{}, {}, "By", Ink::vermillion, true}));
  figure.caption += window_note(window);
  return figure;
}

Figure current_figure(const Series& series) {
  const Values t = values(series.column("t_s"));
  Figure figure{"Coil currents", "Current through each coil, constant within a frame.",
                over_time("current (A)", "Coil currents over time")};
  constexpr Ink kInks[] = {Ink::blue, Ink::vermillion, Ink::green, Ink::purple};
  double window = 0;
  for (std::size_t coil = 0;; ++coil) {
    const std::string name = fmt::format("current_{}_a", coil);
    if (!series.has(name)) break;
    const Line style{{}, {}, fmt::format("coil {}", coil), kInks[coil % std::size(kInks)], coil % 2 == 1};
    window = std::max(window, add_command(figure.plot, t, values(series.find(name)), style));
  }
  figure.caption += window_note(window);
  return figure;
}

Figure count_figure(const Series& series) {
  const Values t = values(series.column("t_s"));
  const bool estimated = is_estimated(series);
  Figure figure{
      "Cells",
      estimated ? "Estimated number of cells in the picture."
                : "Number of cells in the picture, and number of responsive cells.",
      over_time("cells", estimated ? "Visible cells over time" : "Visible and responsive cells over time")};
  figure.plot.y.lo = 0;
  figure.plot.y.ticks = Ticks::integers;
  if (series.has("visible_count")) {
    figure.plot.add(Line{t, values(series.find("visible_count")), "visible", Ink::blue});
  }
  if (!estimated) {
    figure.plot.add(Line{t, values(series.find("responding_count")), "responsive", Ink::vermillion, true});
  }
  return figure;
}

}  // namespace

std::vector<Figure> run_figures(const Series& series, const Metrics& metrics, const RunInfo& info) {
  std::vector<Figure> figures;
  if (series.size() == 0) return figures;
  if (metrics.initial_error_px) figures.push_back(distance_figure(series, metrics, info));
  figures.push_back(path_figure(series, metrics, info));
  const double settling = metrics.settling_time_s.value_or(0);
  if (settling > 0 && settling < kShortApproach * metrics.duration_s) {
    figures.push_back(approach_figure(figures.front(), series, metrics));
  }
  if (metrics.settling_time_s && metrics.steady_rms_px)
    figures.push_back(holding_figure(series, metrics, info));
  figures.push_back(dispersion_figure(series, info));
  if (has_number(series.find("field_x_ut")) && has_number(series.find("field_y_ut"))) {
    figures.push_back(field_figure(series));
  }
  if (has_number(series.find("current_0_a"))) figures.push_back(current_figure(series));
  if (varies(series.find("visible_count")) || varies(series.find("responding_count"))) {
    figures.push_back(count_figure(series));
  }
  return figures;
}

}  // namespace faba
