// The sentences on a run, in its report and in the terminal.
#include <doctest/doctest.h>

#include <string>

#include "study/pages/run_report.h"

namespace {

using faba::Metrics;
using faba::RunInfo;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

RunInfo scaled_run() {
  RunInfo info;
  info.um_per_px = 0.5;
  return info;
}

/// Of a run with one setpoint that did not settle.
Metrics metrics_of_run() {
  Metrics m;
  m.frames = 100;
  m.duration_s = 30;
  m.setpoints = 1;
  m.initial_error_px = 300;
  m.final_distance_px = 80;
  m.sigma_x_px = 12;
  m.sigma_y_px = 34.5;
  return m;
}

}  // namespace

TEST_CASE("run summary: a run with one setpoint") {
  RunInfo info = scaled_run();
  Metrics m = metrics_of_run();

  SUBCASE("never settled") {
    const faba::RunSummary summary = run_summary(m, info);
    CHECK(summary.outcome ==
          "The swarm did not settle at its setpoint: the distance was 300\u00A0px (150\u00A0µm) at the start "
          "and "
          "80.0\u00A0px (40.0\u00A0µm) at the end of the run (30.0\u00A0s).");
    CHECK(summary.details ==
          "At the end, the standard deviations of the cell positions in x and y were "
          "12.0\u00A0×\u00A034.5\u00A0px (6.00\u00A0×\u00A017.2\u00A0µm).");
  }
  SUBCASE("settled") {
    m.settling_time_s = 4.25;
    m.steady_rms_px = 2;
    CHECK(
        run_summary(m, info).outcome ==
        "The swarm settled at its setpoint after 4.25\u00A0s; its rms distance to the setpoint over the last "
        "third of the run was 2.00\u00A0px (1.00\u00A0µm).");
    info.um_per_px.reset();
    CHECK(has(run_summary(m, info).outcome, "of the run was 2.00\u00A0px."));
  }
  SUBCASE("settled within the last third of the run") {
    m.settling_time_s = 29;
    m.steady_rms_px = 120;
    const std::string outcome = run_summary(m, info).outcome;
    CHECK(has(outcome, "after 29.0\u00A0s, within the last third of the run; the steady-state error"));
    CHECK_FALSE(has(outcome, "120"));
  }
  SUBCASE("one cell has no dispersion") {
    info.swarm_cells = {1};
    CHECK(run_summary(m, info).details.empty());
  }
  SUBCASE("at the setpoint from the start") {
    m.settling_time_s = 0;
    m.steady_rms_px = 2;
    CHECK(has(run_summary(m, info).outcome, "was at its setpoint from the start; its rms distance"));
  }
  SUBCASE("a swarm that fills the drop is not passed off as controlled") {
    // Evenly filled, a drop of 300 px has an rms radius of 300 / sqrt(2) = 212 px.
    info.arena = faba::ArenaOutline{"drop", {}, 300.0, {}};
    m.settling_time_s = 3;
    m.steady_rms_px = 2;
    m.initial_rms_radius_px = 20;
    m.rms_radius_px = 158;
    CHECK_FALSE(has(run_summary(m, info).outcome, "dispersed"));
    m.rms_radius_px = 160;
    CHECK(has(run_summary(m, info).outcome,
              "Only the mean of the cells was controlled: they dispersed over the arena (rms radius "
              "20.0\u00A0px (10.0\u00A0µm) "
              "at the start, 160\u00A0px (80.0\u00A0µm) at the end)."));
    m.most_visible = 200;
    m.visible_at_end = 73;
    CHECK(has(run_summary(m, info).outcome, "; the number of cells in view fell from 200 to 73)."));
    info.open_loop = true;  // it was not controlled
    CHECK_FALSE(has(run_summary(m, info).outcome, "dispersed"));
    info.open_loop = false;
    m.initial_rms_radius_px = 110;  // it was dispersed from the start
    CHECK_FALSE(has(run_summary(m, info).outcome, "dispersed"));
  }
}

TEST_CASE("run summary: a run with a route or a moving setpoint") {
  RunInfo info = scaled_run();
  Metrics m = metrics_of_run();

  SUBCASE("a route") {
    m.setpoints = 4;
    m.settling_time_s = 12;
    m.steady_rms_px = 2;
    m.cross_track_95_px = 6;
    const faba::RunSummary summary = run_summary(m, info);
    m.setpoints_reached = 4;
    m.settling_band_px = 15;
    info.setpoint_tolerance_px = 10;
    CHECK(
        run_summary(m, info).outcome.starts_with("The swarm reached 4 of 4 setpoints; the tolerance is "
                                                 "10.0\u00A0px (5.00\u00A0µm). The swarm settled at "
                                                 "the last setpoint after 12.0\u00A0s; its rms"));
    CHECK(has(summary.details, "within 6.00\u00A0px (3.00\u00A0µm) of the route in 95 % of the frames"));
  }
  SUBCASE("an incomplete route") {
    m.given_setpoints = 6;
    m.setpoints = 4;
    m.steady_rms_px = 2;
    m.cross_track_95_px = 6;
    m.settling_band_px = 15;
    m.setpoints_reached = 3;
    CHECK(
        run_summary(m, info).outcome ==
        "The swarm reached 3 of 6 setpoints; the tolerance is 15.0\u00A0px (7.50\u00A0µm). The run ended at "
        "30.0\u00A0s, before the end of the route, so the swarm is not settled. The current setpoint was "
        "number "
        "4 of 6, at a distance of 80.0\u00A0px (40.0\u00A0µm).");
    CHECK(run_summary(m, info).setpoint ==
          "The steady-state error refers to setpoint 4 of 6: the run ended before the last one.");
    info.open_loop = true;
    CHECK(run_summary(m, info).outcome ==
          "The controller does not use the setpoints; distance to setpoint 4 at the end: 80.0\u00A0px "
          "(40.0\u00A0µm).");
    info.open_loop = false;
    m.setpoints = 6;
    CHECK(has(run_summary(m, info).outcome, "did not settle at the last setpoint: the distance was 80.0"));
  }
  SUBCASE("a moving setpoint") {
    m.setpoints = 900;
    m.settling_time_s = 3;
    m.steady_rms_px = 9;
    CHECK(run_summary(m, info).outcome.starts_with("The swarm settled at its moving setpoint"));
    info.path_done = 0.997;
    CHECK(
        run_summary(m, info).outcome.starts_with("The run ended when the swarm had followed 99 % of its "
                                                 "path. The swarm settled at its moving setpoint"));
    info.path_done = 1;
    CHECK(run_summary(m, info).outcome.starts_with("The swarm followed its path to the end. "));
  }
  SUBCASE("two swarms with a setpoint each") {
    info.two_swarm_distances_px = {3, 40};
    const std::string text = run_summary(m, info).outcome;
    CHECK(has(text,
              "the first was 3.00\u00A0px (1.50\u00A0µm) and the second 40.0\u00A0px (20.0\u00A0µm) from its "
              "setpoint"));
    CHECK_FALSE(has(text, "settle"));
  }
}
