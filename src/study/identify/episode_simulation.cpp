#include "study/identify/episode_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/run/simulation.h"
#include "study/stats/study_random.h"

namespace faba {
namespace {

// A round cell of this share of the width that is seen, blurred by this one, is seen that wide (full width at
// half maximum F: (F / 2.355)^2 = d^2 / 16 + s^2).
constexpr double kDiameter = 0.85, kBlur = 0.3676;
constexpr double kFar = 1e5;  // px: the edge of a place that has none

std::string quantity(double value, const char* unit) { return fmt::format("{} {}", value, unit); }

Json arena_of(const ResponseVideo& v, Boundary boundary) {
  const Json view{v.view.width, v.view.height};
  if (boundary == Boundary::box) return {{"type", "box"}, {"size_px", view}};
  if (boundary == Boundary::drop)
    return {{"type", "drop"},
            {"view_px", view},
            {"centre_px", {v.edge->centre_image.x, v.edge->centre_image.y}},
            {"radius_px", v.edge->radius_px}};
  return {{"type", "drop"},
          {"view_px", view},
          {"centre_px", {(v.view.width - 1) / 2.0, (v.view.height - 1) / 2.0}},
          {"radius_px", std::min(kFar, 20.0 * std::hypot(v.view.width, v.view.height))}};
}

// South-seeking cells, which is what scenarios have unless they say otherwise, swim against the field; the
// world's y axis points up.
Json field_along(double direction_deg, double strength_t, bool north) {
  const Vec2 way = unit_vector(direction_deg);
  const double b = north ? strength_t : -strength_t;
  return {quantity(b * way.x, "T"), quantity(-b * way.y, "T")};
}

/// Looks at the moments that are measured.
class Watch final : public Sink {
 public:
  Watch(const std::vector<double>& times, double lead_s, Simulation& simulation, const Scenario& s, Look look)
      : simulation_(simulation), look_(look) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double frame = std::round((times[i] + lead_s) * s.camera.rate);
      wanted_[std::uint64_t(std::clamp(frame, 0.0, double(s.frames() - 1)))].push_back(i);
    }
    look == Look::video ? seen.frames.resize(times.size()) : seen.positions.resize(times.size());
  }
  void take(const Tick& t) override {
    const auto it = wanted_.find(t.index);
    if (it == wanted_.end()) return;
    for (const std::size_t i : it->second)
      look_ == Look::video ? take_picture(seen.frames[i]) : take_positions(seen.positions[i]);
  }
  SeenEpisode seen;

 private:
  void take_picture(GrayF& out) {
    const ImageRef picture = simulation_.rig().picture();
    out = GrayF(picture->width, picture->height);
    std::copy(picture->px.begin(), picture->px.end(), out.px.begin());
  }
  void take_positions(std::vector<Vec2>& out) {
    const auto x = simulation_.world().state().agents["x"], y = simulation_.world().state().agents["y"];
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec2 at = simulation_.frame().image_from_world({double(x[i]), double(y[i])});
      if (simulation_.frame().in_view(at)) out.push_back(at);
    }
  }
  Simulation& simulation_;
  Look look_;
  std::map<std::uint64_t, std::vector<std::size_t>> wanted_;
};

}  // namespace

SegmentTiming exact_timing(const Episode& e) {
  SegmentTiming t;
  for (const FieldSegment& d : e.segments) t.turns_s.push_back(d.t0_s);
  return t;
}

SegmentTiming drawn_timing(const Episode& e, double sd_s, std::uint64_t seed) {
  StudyRandom random(seed, StudyDraws::timing);
  SegmentTiming t;
  for (const FieldSegment& d : e.segments)
    t.turns_s.push_back(d.t0_s + sd_s * std::clamp(random.normal(), -2.5, 2.5));
  t.lead_s = std::max(0.0, -t.turns_s.front());
  for (double& turn : t.turns_s) turn += t.lead_s;
  std::sort(t.turns_s.begin(), t.turns_s.end());
  return t;
}

Document episode_scenario(const ResponseVideo& v, const Episode& e, const EpisodeSettings& settings,
                          const SegmentTiming& timing) {
  Document d;
  d.name = settings.model.origin;
  Json places = Json::array();
  for (const Vec2 at : e.places_image) places.push_back({at.x, at.y});
  const double px = v.um_per_px;
  d.root = {{"title", e.name},
            {"duration", quantity(timing.lead_s + e.length_s() + 1 / v.fps, "s")},
            {"exposure", quantity(v.input.exposure_s, "s")},
            {"scale", {{"um_per_px", px}}},
            {"camera", {{"rate", quantity(v.fps, "Hz")}}},
            {"microscope",
             {{"background", v.file.string()},
              {"cell_diameter", quantity(kDiameter * v.cell_px * px, "um")},
              {"psf_sd", quantity(kBlur * v.cell_px * px, "um")},
              {"contrast", v.contrast}}},
            {"arena", arena_of(v, settings.boundary)},
            {"swarm", Json::array({{{"count", places.size()},
                                    {"model", "dipole"},
                                    {"start", {{"type", "places"}, {"places_px", places}}}}})},
            {"estimator", "none"},
            {"record", {{"tracks", false}, {"video", true}, {"as_seen", true}}}};
  // Few are in view and the place has no end: no grid of it.
  if (settings.boundary == Boundary::none) d.root["exclusion"] = {{"order", "none"}};
  d.root.merge_patch(settings.scene);
  Json& swarm = d.root["swarm"][0];
  // Held at the edge they head there: the first turn of the field takes them a U-turn, too.
  if (settings.boundary != Boundary::none && !swarm.contains("heading"))
    swarm["heading"] = quantity(-(e.segments[0].direction_deg + 180), "deg");
  const bool north = swarm.contains("polarity") && swarm["polarity"] == "north";
  const auto along = [&](double deg) { return field_along(deg, settings.field_strength_t, north); };
  Json first = along(e.segments[0].direction_deg), segments = Json::array();
  if (timing.turns_s[0] > 0)
    first =
        settings.boundary == Boundary::none ? Json{"0 T", "0 T"} : along(e.segments[0].direction_deg + 180);
  for (std::size_t i = 0; i < e.segments.size(); ++i)
    if (timing.turns_s[i] > 0)
      segments.push_back(
          {{"at", quantity(timing.turns_s[i], "s")}, {"field", along(e.segments[i].direction_deg)}});
  d.root["controller"] = {{"type", "manual"}, {"field", first}};
  if (!segments.empty()) d.root["controller"]["segment"] = segments;
  apply(settings.model, "model", d);
  return d;
}

SeenEpisode simulate_episode(const Scenario& s, std::uint64_t seed, double lead_s,
                             const std::vector<double>& times_s, Look look,
                             const std::shared_ptr<const VideoGround>& ground) {
  Pool pool(1);
  Scenario looked_at = s;
  looked_at.record = {};
  looked_at.record.as_seen = look == Look::video;
  Simulation simulation(looked_at, seed, pool, ground);
  Watch watch(times_s, lead_s, simulation, looked_at, look);
  simulation.loop().sinks.push_back(&watch);
  run(simulation.loop(), s.frames(), [] { return true; });
  return std::move(watch.seen);
}

}  // namespace faba
