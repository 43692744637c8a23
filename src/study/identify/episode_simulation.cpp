#include "study/identify/episode_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "app/run/simulation.h"
#include "study/stats/study_random.h"

namespace faba {
namespace {

// A round cell of diameter d = 0.85 F, blurred with sd s = 0.3676 F, has full width at half maximum F:
// (F / 2.355)^2 = d^2 / 16 + s^2.
constexpr double kDiameter = 0.85, kBlur = 0.3676;
constexpr double kUnbounded = 16384;  // px: largest radius of an arena, for one without boundary

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
          {"radius_px", std::min(kUnbounded, 20.0 * std::hypot(v.view.width, v.view.height))}};
}

// South-seeking cells, the default of scenarios, swim against the field. The y axis of the world points up.
Json field_along(double direction_deg, double strength_t, bool north) {
  const Vec2 direction = unit_vector(direction_deg);
  const double b = north ? strength_t : -strength_t;
  return {quantity(b * direction.x, "T"), quantity(-b * direction.y, "T")};
}

// The field in the segments, and `before` them. The controller sets it at the first frame that is not earlier
// than a segment. Times between frames are rounded to the nearest frame; otherwise all reversals would be
// half a frame late on average. Of segments that start at the same frame the last one counts.
Json controller_of(const Episode& e, const SegmentTiming& timing, double fps,
                   const std::function<Json(double)>& along, Json before) {
  Json first = std::move(before), segments = Json::array();
  double last_s = 0;
  for (std::size_t i = 0; i < e.segments.size(); ++i) {
    const double at_s = std::round(timing.starts_s[i] * fps) / fps;
    const Json field = along(e.segments[i].direction_deg);
    if (at_s <= 0)
      first = field;
    else if (at_s == last_s)
      segments.back()["field"] = field;
    else
      segments.push_back({{"at", quantity(at_s, "s")}, {"field", field}});
    last_s = at_s;
  }
  Json controller{{"type", "manual"}, {"field", first}};
  if (!segments.empty()) controller["segment"] = segments;
  return controller;
}

// Divides the swarm into equal populations.
void add_populations(Json& swarms, const Variant& model) {
  const auto populations = model.extra.value(kPopulations, std::size_t(1));
  if (populations < 2) return;
  swarms[0]["count"] = std::max<std::size_t>(1, swarms[0]["count"].get<std::size_t>() / populations);
  while (swarms.size() < populations) swarms.push_back(swarms[0]);
}

std::vector<Vec2> positions_of(const State& state) {
  const auto x = state.agents["x"], y = state.agents["y"];
  std::vector<Vec2> positions;
  for (std::size_t i = 0; i < x.size(); ++i) positions.push_back({double(x[i]), double(y[i])});
  return positions;
}

// Order of positions in m: by strips along the direction, with equal numbers of cells, and along it within a
// strip. y points up.
std::vector<std::size_t> strip_order(const std::vector<Vec2>& positions, double direction_deg) {
  const Vec2 image = unit_vector(direction_deg), along{image.x, -image.y}, across{-along.y, along.x};
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto by = [&](Vec2 axis) {
    return [&positions, axis](std::size_t a, std::size_t b) {
      return dot(positions[a], axis) < dot(positions[b], axis);
    };
  };
  std::stable_sort(order.begin(), order.end(), by(across));
  const std::size_t strip = std::size_t(std::ceil(std::sqrt(double(order.size()))));
  for (std::size_t i = 0; i < order.size(); i += strip)
    std::stable_sort(order.begin() + std::ptrdiff_t(i),
                     order.begin() + std::ptrdiff_t(std::min(i + strip, order.size())), by(along));
  return order;
}

/// Records the frames or cell positions at the times of the statistics.
class EpisodeSink final : public Sink {
 public:
  EpisodeSink(const std::vector<double>& times, const EpisodeLead& lead, Simulation& simulation,
              const Scenario& s, Look look)
      : simulation_(simulation),
        look_(look),
        lead_(lead),
        start_(std::uint64_t(std::lround(lead.duration_s * s.camera.rate))),
        initial_(positions_of(simulation.world().state())) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double frame = std::round((times[i] + lead.duration_s) * s.camera.rate);
      wanted_[std::uint64_t(std::clamp(frame, 0.0, double(s.frames() - 1)))].push_back(i);
    }
    look == Look::video ? seen.frames.resize(times.size()) : seen.positions.resize(times.size());
  }
  void take(const Tick& t) override {
    if (t.index == start_ && start_ > 0) restore_positions();
    const auto it = wanted_.find(t.index);
    if (it == wanted_.end()) return;
    for (const std::size_t i : it->second)
      look_ == Look::video ? take_picture(seen.frames[i]) : take_positions(seen.positions[i]);
  }
  EpisodeObservation seen;

 private:
  // The initial positions were measured at the start of the episode.
  void restore_positions() {
    State now = simulation_.world().state();
    const std::vector<Vec2> places = rearranged(initial_, positions_of(now), lead_.direction_deg);
    const auto x = now.agents["x"], y = now.agents["y"];
    for (std::size_t i = 0; i < places.size(); ++i) {
      x[i] = float(places[i].x);
      y[i] = float(places[i].y);
    }
    simulation_.world().restore(now);
  }
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
  EpisodeLead lead_;
  std::uint64_t start_;              ///< first frame of the episode
  const std::vector<Vec2> initial_;  ///< measured positions, m
  std::map<std::uint64_t, std::vector<std::size_t>> wanted_;
};

}  // namespace

SegmentTiming exact_timing(const Episode& e) {
  SegmentTiming t;
  for (const FieldSegment& d : e.segments) t.starts_s.push_back(d.t0_s);
  return t;
}

SegmentTiming random_timing(const Episode& e, const TimingErrors& errors, std::uint64_t seed) {
  StudyRandom random(seed, StudyDraws::timing);
  SegmentTiming t;
  for (const FieldSegment& d : e.segments)
    t.starts_s.push_back(d.t0_s + errors.sd_s * std::clamp(random.normal(), -2.5, 2.5));
  const double early = std::ceil(std::max(0.0, -t.starts_s.front()) / errors.frame_s);
  t.lead_s = errors.frame_s *
             (early + errors.history_frames + double(random.below(std::size_t(errors.clock_frames))));
  for (double& start : t.starts_s) start += t.lead_s;
  std::sort(t.starts_s.begin(), t.starts_s.end());
  return t;
}

Document episode_scenario(const ResponseVideo& v, const Episode& e, const EpisodeSettings& settings,
                          const SegmentTiming& timing) {
  Document d;
  d.name = settings.model.origin;
  Json places = Json::array();
  for (const Vec2 at : e.positions_image) places.push_back({at.x, at.y});
  const double px = v.um_per_px * settings.scale_factor;
  d.root = {{"title", e.name},
            {"duration", quantity(timing.lead_s + e.length_s() + 1 / v.fps, "s")},
            {"exposure", quantity(std::max(0.0, v.input.exposure_s + e.start_s - timing.lead_s), "s")},
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
  // An occupancy grid of the large arena would be too large, and cells are sparse.
  if (settings.boundary == Boundary::none) d.root["exclusion"] = {{"order", "none"}};
  d.root.merge_patch(settings.scene);
  Json& swarm = d.root["swarm"][0];
  // Cells at the edge head towards it, so the first field reversal needs a U-turn as well.
  if (settings.boundary != Boundary::none && !swarm.contains("heading"))
    swarm["heading"] = quantity(-(e.segments[0].direction_deg + 180), "deg");
  const bool north = swarm.contains("polarity") && swarm["polarity"] == "north";
  const auto along = [&](double deg) { return field_along(deg, settings.field_strength_t, north); };
  d.root["controller"] = controller_of(
      e, timing, v.fps, along,
      settings.boundary == Boundary::none ? Json{"0 T", "0 T"} : along(e.segments[0].direction_deg + 180));
  add_populations(d.root["swarm"], settings.model);
  apply(settings.model, "model", d);
  return d;
}

std::vector<Vec2> rearranged(const std::vector<Vec2>& places, const std::vector<Vec2>& like,
                             double direction_deg) {
  const std::vector<std::size_t> from = strip_order(places, direction_deg),
                                 to = strip_order(like, direction_deg);
  std::vector<Vec2> out(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) out[to[i]] = places[from[i]];
  return out;
}

EpisodeObservation simulate_episode(const Scenario& s, std::uint64_t seed, const EpisodeLead& lead,
                                    const std::vector<double>& times_s, Look look,
                                    const std::shared_ptr<const VideoBackground>& ground) {
  Pool pool(1);
  Scenario scenario = s;
  scenario.record = {};
  scenario.record.as_seen = look == Look::video;
  Simulation simulation(scenario, seed, pool, ground);
  EpisodeSink sink(times_s, lead, simulation, scenario, look);
  simulation.loop().sinks.push_back(&sink);
  run(simulation.loop(), s.frames(), [] { return true; });
  return std::move(sink.seen);
}

}  // namespace faba
