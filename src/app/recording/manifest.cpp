#include "app/recording/manifest.h"

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

Json latency_json(const Latency& l) {
  const auto number = [](double v) { return std::isnan(v) ? Json() : Json(v); };
  return {
      {"median", number(l.median)}, {"p99", number(l.p99)}, {"p999", number(l.p999)}, {"max", number(l.max)}};
}

Json arena_json(const Manifest& m) {
  Json j = {{"type", m.arena_type}, {"centre_px", {m.arena_centre_px.x, m.arena_centre_px.y}}};
  if (m.arena_radius_px > 0)
    j["radius_px"] = m.arena_radius_px;
  else
    j["size_px"] = {int(m.view_px.x), int(m.view_px.y)};
  return j;
}

Json swarms_json(const std::vector<Manifest::Swarm>& swarms) {
  Json all = Json::array();
  for (const Manifest::Swarm& s : swarms) all.push_back(swarm_json(s));
  return all;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

void add_simulated(Json& j, const Manifest& m) {
  const Manifest::Simulated& s = *m.simulated;
  j.update({{"threads", s.threads},
            {"state_hash", s.state_hash},
            {"frames", m.frames},
            {"duration_s", m.duration_s},
            {"step_s", s.step_s},
            {"steps", s.steps},
            {"wall_time_s", m.wall_time_s},
            {"cells", s.cells},
            {"swarms", swarms_json(s.swarms)},
            {"setpoints", m.setpoints},
            {"setpoint_tolerance_px", or_null(m.setpoint_tolerance_px)},
            {"path_done", or_null(m.path_done)},
            {"video_shows", m.video_shows},
            {"distance_source", m.distance_source},
            {"notes", m.notes}});
}

void add_bench(Json& j, const Manifest& m) {
  const Manifest::Bench& b = *m.bench;
  j.update({{"rig", {{"camera", b.camera}, {"driver", b.driver}}},
            {"frames", m.frames},
            {"duration_s", m.duration_s},
            {"wall_time_s", m.wall_time_s},
            {"notes", m.notes},
            {"setpoints", m.setpoints},
            {"setpoint_tolerance_px", or_null(m.setpoint_tolerance_px)},
            {"path_done", or_null(m.path_done)},
            {"video_shows", m.video_shows},
            {"distance_source", m.distance_source},
            {"frames_dropped", b.frames_dropped},
            {"delay_ms", b.delay_ms},
            {"frames_corrupt", b.frames_corrupt},
            {"arrival_ms", latency_json(b.arrival)},
            {"command_ms", latency_json(b.command)},
            {"recorder_most_behind", b.recorder_most_behind},
            {"guard",
             {{"state", b.guard_state},
              {"commands", b.guard_commands},
              {"refused", b.guard_refused},
              {"command_timeouts", b.command_timeouts},
              {"heat", b.guard_heat}}}});
}

}  // namespace

Manifest manifest_of(const Scenario& s, std::uint64_t seed, const Frame& frame, const Outline& outline) {
  Manifest m;
  m.title = s.params.title;
  m.scenario_hash = s.hash();
  m.seed = seed;
  m.um_per_px = s.scale.um_per_px;
  if (!m.um_per_px) m.nominal_um_per_px = s.scale.used_um_per_px();
  m.um_per_px_source = scale_source_json(s.scale);
  m.view_px = {double(frame.width), double(frame.height)};
  m.arena_type = s.arena.type;
  m.arena_centre_px = outline.centre_image;
  m.arena_radius_px = outline.radius_px;
  m.open_loop =
      s.controller.has(Trait::open_loop) && std::all_of(s.events.begin(), s.events.end(), [](const Event& e) {
        return !e.controller || e.controller->has(Trait::open_loop);
      });
  m.polarity = s.polarity() > 0 ? "north" : "south";
  return m;
}

Json swarm_json(const Manifest::Swarm& s) {
  Json j = Swarm::schema().to_json(s.params);
  j["model"] = s.model;
  j["start"] = s.start;
  return j;
}

Json manifest_json(const Manifest& m) {
  Json j = {{"version", FABA_VERSION},
            {"title", m.title},
            {"scenario_hash", m.scenario_hash},
            {"seed", m.seed},
            {"um_per_px", m.um_per_px ? Json(*m.um_per_px) : Json()},
            {"um_per_px_source", m.um_per_px_source},
            {"view_px", {int(m.view_px.x), int(m.view_px.y)}},
            {"arena", arena_json(m)},
            {"polarity", m.polarity},
            {"complete", m.complete},
            {"date", m.date},
            {"out", m.out.string()}};
  if (m.nominal_um_per_px) j["nominal_um_per_px"] = *m.nominal_um_per_px;
  if (m.recorded_s) j["recorded_s"] = {m.recorded_s->x, m.recorded_s->y};
  if (m.two_swarm_distances_px) j["two_swarm_distances_px"] = *m.two_swarm_distances_px;
  for (const std::vector<Vec2>& polygon : m.obstacles_px) {
    Json corners = Json::array();
    for (const Vec2 corner : polygon) corners.push_back({corner.x, corner.y});
    j["obstacles_px"].push_back(std::move(corners));
  }
  if (m.simulated) add_simulated(j, m);
  if (m.bench) add_bench(j, m);
  return j;
}

}  // namespace faba
