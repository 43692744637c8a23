#include "study/pages/run_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/file.h"
#include "study/data/series.h"
#include "study/data/sha256.h"
#include "study/pages/frame_strip.h"
#include "study/pages/latency_figure.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/pages/run_figures.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"

namespace faba {
namespace {

constexpr double kLate = 2.0 / 3;  // fraction of the run; start of the steady-state error

/// "12.3 px (9.86 µm)", in mm from 1000 µm, or only pixels without a picture scale.
std::string length_text(double px, const RunInfo& info) {
  std::string text = three_digits(px) + "\u00A0px";
  if (!info.um_per_px) return text;
  const double um = px * *info.um_per_px;
  text += um < 1000 ? fmt::format(" ({}\u00A0µm)", three_digits(um))
                    : fmt::format(" ({}\u00A0mm)", three_digits(um / 1000));
  return text;
}

std::string seconds(double s) { return three_digits(s) + "\u00A0s"; }

// One cell has no dispersion.
bool has_one_cell(const RunInfo& info) { return info.swarm_cells == std::vector<std::uint64_t>{1}; }

std::string dispersion_text(const Metrics& m, const RunInfo& info) {
  if (!m.sigma_x_px || !m.sigma_y_px || has_one_cell(info)) return {};
  std::string text =
      fmt::format("{}\u00A0×\u00A0{}\u00A0px", three_digits(*m.sigma_x_px), three_digits(*m.sigma_y_px));
  if (info.um_per_px) {
    text += fmt::format(" ({}\u00A0×\u00A0{}\u00A0µm)", three_digits(*m.sigma_x_px * *info.um_per_px),
                        three_digits(*m.sigma_y_px * *info.um_per_px));
  }
  return text;
}

/// Duration of a run, s: number of frames / frame rate, from the manifest. Without it: from the first to the
/// last frame.
double run_duration(const Metrics& m, const RunInfo& info) { return info.duration_s.value_or(m.duration_s); }

/// "The swarm reached 1 of 4 setpoints; the tolerance is 10.0 px.": the same number as setpoints_reached of
/// --json.
std::string reached_text(const Metrics& m, std::size_t setpoints, const RunInfo& info) {
  const double tolerance = info.setpoint_tolerance_px.value_or(m.settling_band_px.value_or(0));
  return fmt::format("The swarm reached {:.0f} of {} setpoints; the tolerance is {}.",
                     m.setpoints_reached.value_or(0), setpoints, length_text(tolerance, info));
}

/// Of a run with one setpoint, with a moving one, or with a route up to its last setpoint.
std::string settling_text(const std::string& goal, bool single, const Metrics& m, const RunInfo& info) {
  const std::string duration = seconds(run_duration(m, info));
  if (!m.settling_time_s) {
    const std::string start =
        single ? fmt::format("{} at the start and ", length_text(*m.initial_error_px, info)) : "";
    return fmt::format("The swarm did not settle at {}: the distance was {}{} at the end of the run ({}).",
                       goal, start, length_text(*m.final_distance_px, info), duration);
  }
  if (*m.settling_time_s > kLate * m.duration_s) {
    return fmt::format(
        "The swarm settled at {} after {}, within the last third of the run; the steady-state error "
        "therefore "
        "includes the approach. At the end of the run ({}) the distance was {}.",
        goal, seconds(*m.settling_time_s), duration, length_text(*m.final_distance_px, info));
  }
  std::string text = *m.settling_time_s == 0
                         ? fmt::format("The swarm was at {} from the start", goal)
                         : fmt::format("The swarm settled at {} after {}", goal, seconds(*m.settling_time_s));
  if (m.steady_rms_px) {
    text += fmt::format("; its rms distance to the setpoint over the last third of the run was {}",
                        length_text(*m.steady_rms_px, info));
  }
  return text + ".";
}

/// Empty for a reference without a path.
std::string path_text(const RunInfo& info) {
  if (!info.path_done) return "";
  if (*info.path_done >= 1) return "The swarm followed its path to the end. ";
  // Rounded down: only a path that was followed to its end has 100 %.
  return fmt::format("The run ended when the swarm had followed {:.0f} % of its path. ",
                     std::floor(100 * *info.path_done));
}

std::string two_swarms_text(const std::array<double, 2>& distance_px, const Metrics& m, const RunInfo& info) {
  return fmt::format(
      "The controller steers two swarms to a setpoint each. At the end of the run ({}) the first was {} "
      "and the second {} from its setpoint, as the controller followed the centres of their circles.",
      seconds(run_duration(m, info)), length_text(distance_px[0], info), length_text(distance_px[1], info));
}

/// Root-mean-square distance from the centre of points that fill the arena evenly, px.
double even_rms_radius_px(const ArenaOutline& arena) {
  if (arena.radius_px) return *arena.radius_px / std::sqrt(2.0);
  return arena.size_px ? norm(*arena.size_px) / std::sqrt(12.0) : std::numeric_limits<double>::infinity();
}

/// Of a swarm that was compact and has filled its arena: the distance of its mean to the setpoint does not
/// show it.
std::string dispersed_text(const Metrics& m, const RunInfo& info) {
  if (info.open_loop || info.two_swarm_distances_px) return "";
  if (!info.arena || !m.initial_rms_radius_px || !m.rms_radius_px) return "";
  constexpr double kCompact = 0.5, kFilled = 0.75;  // of a swarm that fills the arena evenly; assumed
  const double even = even_rms_radius_px(*info.arena);
  if (*m.initial_rms_radius_px > kCompact * even || *m.rms_radius_px < kFilled * even) return "";
  std::string text = fmt::format(
      " Only the mean of the cells was controlled: they dispersed over the arena (rms radius {} at the "
      "start, {} "
      "at the end",
      length_text(*m.initial_rms_radius_px, info), length_text(*m.rms_radius_px, info));
  if (m.visible_at_end && m.most_visible && *m.visible_at_end < 0.9 * *m.most_visible)
    text += fmt::format("; the number of cells in view fell from {:.0f} to {:.0f}", *m.most_visible,
                        *m.visible_at_end);
  return text + ").";
}

std::string outcome_text(const Metrics& m, const RunInfo& info) {
  if (info.two_swarm_distances_px) return two_swarms_text(*info.two_swarm_distances_px, m, info);
  const std::size_t given = std::max(m.setpoints, m.given_setpoints);
  if (info.open_loop) {
    return fmt::format("The controller does not use the {}; distance to {} at the end: {}.",
                       given > 1 ? "setpoints" : "setpoint",
                       given > 1 ? fmt::format("setpoint {}", m.setpoints) : "the setpoint",
                       length_text(*m.final_distance_px, info));
  }
  if (given > Metrics::kMaxRouteSetpoints)
    return path_text(info) + settling_text("its moving setpoint", false, m, info);
  if (given <= 1) return settling_text("its setpoint", true, m, info);
  const std::string reached = reached_text(m, given, info);
  if (m.route_unfinished()) {
    return fmt::format(
        "{} The run ended at {}, before the end of the route, so the swarm is not settled. The current "
        "setpoint was number {} of {}, at a distance of {}.",
        reached, seconds(run_duration(m, info)), m.setpoints, given, length_text(*m.final_distance_px, info));
  }
  return reached + " " + settling_text("the last setpoint", false, m, info);
}

std::string metric_row(const MetricInfo& one, double value, const RunInfo& info) {
  const double shown = one.shown * value;
  std::string cells = one.count ? fmt::format("<td>{:.0f}</td>", value)
                                : fmt::format("<td>{}\u00A0{}</td>", three_digits(shown), one.unit);
  if (info.um_per_px)
    cells += one.in_um ? fmt::format("<td>{}\u00A0{}</td>", three_digits(shown * *info.um_per_px), one.in_um)
                       : "<td></td>";
  return fmt::format("<tr><th scope=\"row\">{}<small>{}</small></th>{}</tr>\n", one.name, one.meaning, cells);
}

std::string metrics_table(const Metrics& m, const RunInfo& info) {
  std::string out = "<h2>Metrics</h2>\n<table class=\"numbers\"><thead><tr><th scope=\"col\">Quantity</th>";
  out += info.um_per_px ? "<th scope=\"col\">in pixels</th><th scope=\"col\">in µm</th>"
                        : "<th scope=\"col\">Value</th>";
  out += "</tr></thead>\n<tbody>\n";
  std::string_view group;
  for (const MetricInfo& one : metric_list()) {
    const std::optional<double>& value = m.*one.value;
    if (!value) continue;
    if (one.group != group)
      out += fmt::format("<tr><th colspan=\"{}\" scope=\"colgroup\">{}</th></tr>\n", info.um_per_px ? 3 : 2,
                         one.group);
    group = one.group;
    out += metric_row(one, *value, info);
  }
  return out + "</tbody></table>\n";
}

std::string card(const char* name, const std::string& value, const std::string& detail) {
  return fmt::format("<div><dt>{}</dt><dd><b>{}</b><span>{}</span></dd></div>\n", name, value, detail);
}

std::string in_um(double px, const RunInfo& info, const char* otherwise) {
  return info.um_per_px ? three_digits(px * *info.um_per_px) + "\u00A0µm" : std::string(otherwise);
}

std::string two_swarm_cards(const std::array<double, 2>& distance_px) {
  const char* detail = "from its setpoint, last frame";
  return card("First swarm", three_digits(distance_px[0]) + "\u00A0px", detail) +
         card("Second swarm", three_digits(distance_px[1]) + "\u00A0px", detail);
}

std::string error_cards(const Metrics& m, const RunInfo& info) {
  std::string out;
  if (m.initial_error_px) {
    out += card("Settling time", m.settling_time_s ? seconds(*m.settling_time_s) : "not settled",
                fmt::format("band ±{}\u00A0px", three_digits(*m.settling_band_px)));
  }
  if (m.steady_rms_px) {
    out += card("Steady-state error, rms", three_digits(*m.steady_rms_px) + "\u00A0px",
                in_um(*m.steady_rms_px, info, "last third"));
  }
  return out;
}

std::string cards(const Metrics& m, const RunInfo& info) {
  std::string out =
      info.two_swarm_distances_px ? two_swarm_cards(*info.two_swarm_distances_px) : error_cards(m, info);
  if (m.cross_track_rms_px) {
    out += card("Cross-track error, rms", three_digits(*m.cross_track_rms_px) + "\u00A0px",
                in_um(*m.cross_track_rms_px, info, "from the second setpoint"));
  }
  if (m.rms_radius_px) {
    out += card("Dispersion, rms radius", three_digits(*m.rms_radius_px) + "\u00A0px",
                in_um(*m.rms_radius_px, info, "last frame"));
  }
  if (m.limited_fraction && m.initial_error_px) {
    out += card("Command limited", three_digits(100 * *m.limited_fraction) + "\u00A0%", "of the frames");
  }
  return out.empty() ? out : "<dl class=\"cards\">\n" + out + "</dl>\n";
}

/// `poster`: the first frame, which browsers show until the video is played; null: none.
std::string video_figure(const RunInfo& info, const SmallFrame* poster) {
  const Vec2 size =
      info.view_px.value_or(Vec2{4, 3});  // aspect ratio of the placeholder until the video is loaded
  return fmt::format(
      "<figure class=\"video\">\n<h3>Video</h3>\n<video controls=\"controls\" preload=\"metadata\" "
      "width=\"{}\" height=\"{}\"{} src=\"video.mp4\"></video>\n<figcaption>{}: <a "
      "href=\"video.mp4\">video.mp4</a> in the directory of this page.</figcaption>\n</figure>\n",
      size.x, size.y, poster ? fmt::format(" poster=\"{}\"", picture_url(poster->picture)) : "",
      info.video_shows == "camera" ? "Camera frames of the run" : "Drawing of the run");
}

std::string figures_section(const std::vector<Figure>& figures, const std::string& video) {
  std::string out = "<h2>Figures</h2>\n<div class=\"figures\">\n";
  int number = 0;
  out += figures_markup(figures, number);
  return out + video + "</div>\n";
}

std::string fact(const char* name, const std::string& value) {
  if (value.empty()) return {};
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, escape_markup(value));
}

// Keys, values and hashes, which are the same in every language.
std::string code_fact(const std::string& name, const std::string& value) {
  if (value.empty()) return {};
  return fmt::format("<tr><th scope=\"row\">{}</th><td><code>{}</code></td></tr>\n", name,
                     escape_markup(value));
}

/// "13.0 s (195 frames of 66.7 ms)"; without a manifest's duration "12.9 s from the first to the last of 195
/// frames".
std::string duration_fact(const Metrics& m, const RunInfo& info) {
  if (!info.duration_s || m.frames == 0)
    return fmt::format("{} s from the first to the last of {} frames", three_digits(m.duration_s), m.frames);
  return fmt::format("{} s ({} frames of {} ms)", three_digits(*info.duration_s), m.frames,
                     three_digits(1000 * *info.duration_s / double(m.frames)));
}

std::string provenance(const Metrics& m, const RunInfo& info, const std::string& scenario) {
  std::string out = "<h2>Provenance</h2>\n<table class=\"facts\"><tbody>\n";
  out += fact("Program", "Faba " + info.version);
  out += fact("Duration", duration_fact(m, info));
  for (std::size_t i = 0; i < info.swarms.size(); ++i) {
    out += code_fact(info.swarms.size() == 1 ? "Swarm" : fmt::format("Swarm {}", i + 1), info.swarms[i]);
  }
  out += code_fact("Polarity", info.polarity);
  if (info.arena) out += code_fact("Arena", info.arena->type);
  if (info.um_per_px) out += fact("Picture scale", fmt::format("{:.4g} µm per px", *info.um_per_px));
  out += fact("Seed", info.seed);
  out += code_fact("Scenario hash", info.scenario_hash);
  out += code_fact("State hash", info.state_hash);
  if (!scenario.empty()) {
    Sha256 sum;
    sum.add(scenario);
    out += fmt::format("<tr><th scope=\"row\">scenario.toml</th><td>SHA-256 {}, with all options</td></tr>\n",
                       short_digest(sum.hex()));
  }
  out +=
      "</tbody></table>\n<p class=\"note\">Date, number of threads and computing time are in "
      "manifest.json.</p>\n";
  if (scenario.empty()) return out;
  const std::string command =
      "faba run scenario.toml" + (info.seed.empty() ? "" : " --seed " + info.seed) + " --out repeated";
  out += fmt::format("<p>To reproduce the run, execute in this directory:</p>\n<pre><code>{}</code></pre>\n",
                     escape_markup(command));
  if (!info.state_hash.empty()) {
    out += fmt::format(
        "<p class=\"note\">The same version of Faba gives the same state hash, <code>{}</code>.</p>\n",
        escape_markup(info.state_hash));
  }
  return out;
}

std::string existing_text(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) ? read_file(file) : std::string();
}

std::string body_of(const std::filesystem::path& run_dir, const std::string& title, const Series& series,
                    const RunInfo& info, const std::vector<SmallFrame>& frames) {
  const Metrics m =
      control_metrics(series, info.setpoint_tolerance_px, std::size_t(info.setpoints.value_or(0)));
  const std::string scenario = existing_text(run_dir / "scenario.toml");
  std::error_code ignored;
  const bool video = std::filesystem::is_regular_file(run_dir / "video.mp4", ignored);
  const std::vector<SmallFrame> shots =
      frames.empty() ? strip_frames(run_dir / (video ? "video.mp4" : "video.avi")) : frames;
  const std::string media =
      (video ? video_figure(info, shots.empty() ? nullptr : &shots.front()) : "") + frame_strip(shots);

  const RunSummary summary = run_summary(m, info);
  std::string out = fmt::format("<h1>{}</h1>\n<p class=\"lead\">{}</p>\n", escape_markup(title),
                                escape_markup(summary.outcome));
  if (!summary.details.empty())
    out += fmt::format("<p class=\"details\">{}</p>\n", escape_markup(summary.details));
  for (const std::string& note : info.notes) out += note_markup(note, "", "warning");
  if (!info.um_per_px)
    out += "<p class=\"note\">The run has no picture scale, so lengths are in pixels only.</p>\n";
  if (!info.complete)
    out +=
        "<p class=\"warning\">The run was stopped before its end; this report covers the recorded "
        "part.</p>\n";
  if (series.last_line_cut()) {
    out +=
        "<p class=\"warning\">The recording ends in the middle of a line, as after an interruption. This "
        "last frame is ignored.</p>\n";
  }
  out += cards(m, info);
  if (!summary.setpoint.empty()) out += fmt::format("<p class=\"note\">{}</p>\n", summary.setpoint);
  std::vector<Figure> figures = run_figures(series, m, info);
  const auto t = series.column("t_s");
  if (t.size() > 1)
    if (auto late = latency_figure(run_dir, (t.back() - t.front()) / double(t.size() - 1)))
      figures.push_back(*late);
  if (!figures.empty() || !media.empty()) out += figures_section(figures, media);
  if (m.frames > 0) out += metrics_table(m, info);
  out += provenance(m, info, scenario);
  if (!scenario.empty()) {
    out += fmt::format(
        "<details><summary>Scenario (scenario.toml)</summary>\n<pre><code>{}</code></pre></details>\n",
        escape_markup(scenario));
  }
  return out;
}

}  // namespace

RunSummary run_summary(const Metrics& m, const RunInfo& info) {
  if (m.frames == 0) return {"No frame was recorded.", ""};
  RunSummary summary;
  if (m.frames == 1) return {"Only one frame was recorded, the start of the run.", ""};
  summary.outcome = m.initial_error_px ? outcome_text(m, info) + dispersed_text(m, info)
                                       : fmt::format("The swarm had no setpoint and was recorded for {}.",
                                                     seconds(run_duration(m, info)));
  if (info.two_swarm_distances_px)
    summary.setpoint =
        "The other figures are those of the mean of all cells and the setpoint of the first swarm; "
        "they do not show whether the swarms are controlled.";
  else if (m.route_unfinished())
    summary.setpoint =
        fmt::format("The steady-state error refers to setpoint {} of {}: the run ended before the last one.",
                    m.setpoints, m.given_setpoints);
  if (m.cross_track_95_px) {
    summary.details =
        fmt::format("After the first setpoint, the swarm was within {} of the route in 95 % of the frames. ",
                    length_text(*m.cross_track_95_px, info));
  }
  const std::string dispersion = dispersion_text(m, info);
  if (!dispersion.empty()) {
    summary.details += fmt::format(
        "At the end, the standard deviations of the cell positions in x and y were {}.", dispersion);
  }
  return summary;
}

void write_run_report(const std::filesystem::path& run_dir, const RunInfo& info, const Series& series,
                      const std::vector<SmallFrame>& frames) {
  const std::string title = info.title.empty() ? "Run report" : info.title;
  write_file(run_dir / "report.html", html_page(title, body_of(run_dir, title, series, info, frames)));
}

}  // namespace faba
