#include "app/run/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/two_swarms.h"
#include "core/counted.h"
#include "field/null.h"

namespace faba {
namespace {

using Notes = std::vector<std::string>;

constexpr std::size_t kListedSetpoints = 50;  // more are a curve, for which one note is enough

void note_setpoints(const Scenario& s, const Simulation& simulation, Notes& notes) {
  const Arena& arena = *simulation.world().parts().arena;
  const std::vector<Vec2> all = simulation.reference().setpoints();
  std::size_t outside = 0;
  for (const Vec2 at : all) {
    const Vec2 px = simulation.frame().image_from_world(at);
    const bool reachable = arena.depth(at) >= 0;
    if (reachable && simulation.frame().in_view(px)) continue;
    ++outside;
    if (all.size() > kListedSetpoints) continue;
    notes.push_back(
        reachable
            ? fmt::format("reference: the setpoint ({:g}, {:g}) px is outside the camera view", px.x, px.y)
            : fmt::format(
                  "reference: the setpoint ({:g}, {:g}) px is outside the {}; the swarm cannot reach it",
                  px.x, px.y, s.arena.type));
  }
  if (outside > 0 && all.size() > kListedSetpoints)
    notes.push_back(fmt::format(
        "reference: {:.0f} % of the curve is outside the camera view or the {}; the swarm cannot be "
        "followed or cannot go there",
        100.0 * double(outside) / double(all.size()), s.arena.type));
}

void note_polarities(const Scenario& s, Notes& notes) {
  const bool north = s.polarity() > 0;
  for (std::size_t i = 0; i < s.swarms.size(); ++i) {
    if ((s.swarms[i].params.polarity == Swarm::Polarity::north) == north) continue;
    notes.push_back(fmt::format(
        "swarm[{0}] is {1}-seeking, but the controller steers the {2}-seeking cells; the field drives "
        "swarm[{0}] away from the setpoint",
        i, north ? "south" : "north", north ? "north" : "south"));
  }
}

std::string in_px(Vec2 px) { return fmt::format("({:.0f}, {:.0f}) px", px.x, px.y); }

constexpr const char* kSaddle =
    "a saddle: a field without divergence that attracts cells along one direction drives them away along the "
    "other. Four coils can trap along both directions, as in rigs/thesis-four-coils.toml (theory C6)";

// Whether the zeros of the field that the controller produces are reachable and trap cells.
void note_traps(const Scenario& s, const Simulation& simulation, Notes& notes) {
  const Field& field = *simulation.world().parts().field;
  const std::vector<Vec2> nulls = simulation.controller().nulls(simulation.reference().setpoints());
  if (nulls.empty()) return;
  if (!field.varies()) {
    notes.push_back(fmt::format(
        "controller: the coils of field \"{}\" have no gradient and cannot produce a zero; use a field with "
        "single coils, as in rigs/thesis-four-coils.toml",
        s.field.type));
    return;
  }
  const std::vector<double> limits = field.max_currents(s.limits.max_current);
  for (const Vec2 at : nulls) {
    const FieldNull n = null_at(field, at, s.polarity(), limits);
    if (n.reachable && !n.saddle) continue;
    const std::string position = in_px(simulation.frame().image_from_world(at));
    const std::string note =
        n.reachable ? fmt::format("controller: the zero of the field at {} is {}", position, kSaddle)
                    : fmt::format(
                          "controller: these coils cannot produce a zero of the field at {}; the swarm "
                          "does not gather there",
                          position);
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }
}

// Zero of the field near the sample for currents given per coil, and its effect on cells.
void note_currents(const Scenario& s, const Simulation& simulation, Notes& notes) {
  const WorldParts& parts = simulation.world().parts();
  for (const std::vector<double>& current : simulation.controller().given_currents()) {
    const Vec2 at = find_null(*parts.field, current, {});
    if (!std::isfinite(at.x) || parts.field->clearance({at.x, at.y, 0}) < 1e-4) continue;
    const std::string position = in_px(simulation.frame().image_from_world(at));
    const double outside = -parts.arena->depth(at);
    const NullGradient g = null_gradient(*parts.field, current, at);
    const bool north = s.polarity() > 0;
    const bool traps = north ? g[1] < 0 : g[0] > 0, repels = north ? g[0] > 0 : g[1] < 0;
    notes.push_back(fmt::format(
        "controller: with these currents the field is zero at {}{}; the zero is {}", position,
        outside > 0
            ? fmt::format(", {:.2g} mm outside the sample, so the swarm moves to one side", outside * 1e3)
            : "",
        traps    ? "a trap"
        : repels ? "a source, from which cells move away in all directions"
                 : kSaddle));
  }
}

/// Largest field of an experiment, T, and what limits it.
struct MaxField {
  double tesla = 0;
  bool by_coils = false;  ///< by the current limits of the coils, else by the controller
};

constexpr double kInPlaneRounding = 1e-6;  // smaller fractions of the field are rounding errors

// Sum of the magnitudes of the fields of all coils in the plane of the sample, in which cells swim, T, at its
// largest in the middle of the arena and halfway to its corners; infinity if all these points are outside a
// measured map.
double field_of(const WorldParts& w, std::span<const double> current) {
  const Grid g = w.arena->grid();
  std::vector<Vec3> b(w.field->coils());
  double most = -1;
  for (const Vec2 part : {Vec2{0.5, 0.5}, {0.25, 0.25}, {0.25, 0.75}, {0.75, 0.25}, {0.75, 0.75}}) {
    const Vec2 at{double(g.left) + part.x * g.columns * double(g.cell),
                  double(g.low) + part.y * g.rows * double(g.cell)};
    w.field->basis({at.x, at.y, 0}, b, {});
    double sum = 0, with_z = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
      sum += std::fabs(current[k]) * std::hypot(b[k].x, b[k].y);
      with_z += std::fabs(current[k]) * norm(b[k]);
    }
    if (sum < kInPlaneRounding * with_z) sum = 0;
    if (sum > most) most = sum;
  }
  return most < 0 ? std::numeric_limits<double>::infinity() : most;
}

// The largest field that the controllers of the run command and the coils produce.
MaxField max_field(const Scenario& s, const Simulation& simulation) {
  const WorldParts& w = simulation.world().parts();
  double commanded = 0;
  const auto add = [&](const Controller& c) {
    commanded = std::max(commanded, c.max_field());
    for (const std::vector<double>& current : c.given_currents())
      commanded = std::max(commanded, field_of(w, current));
  };
  add(simulation.controller());
  for (const Event& e : s.events)
    if (e.controller) add(*e.controller->make(simulation.control()));
  const double coils = field_of(w, simulation.control().max_current);
  return {std::min(coils, commanded), coils < commanded};
}

// Names the parameters with which the field of the controller increases, of those that it has.
std::string controller_advice(const Scenario& s) {
  const Json& all = s.controller.resolved;
  if (all.contains("set") && !all["set"].empty()) return "increase the outputs in controller.set";
  std::string keys;
  for (const char* key : {"gain", "max_output", "field", "current"}) {
    if (!all.contains(key) || (std::string(key) == "gain" && all[key] != 0)) continue;
    keys += (keys.empty() ? "" : " or ") + fmt::format("controller.{}", key);
  }
  return "increase " + (keys.empty() ? "the field of the controller" : keys);
}

// Fields that do not move the cells.
void note_weak_field(const Scenario& s, const Simulation& simulation, Notes& notes) {
  if (s.limits.max_current == 0 || s.frames() < 2) return;  // these have their own note
  const WorldParts& w = simulation.world().parts();
  const std::vector<double> unit_current(w.field->coils(), 1.0);
  if (!unit_current.empty() && field_of(w, unit_current) == 0) {
    notes.emplace_back(
        "field: these coils have no field in the plane of the sample; the cells do not respond to them; use "
        "coils "
        "with an axis in this plane, as in rigs/thesis-four-coils.toml");
    return;
  }
  const MaxField field = max_field(s, simulation);
  if (field.tesla == 0) {
    notes.push_back(fmt::format("{}: no field of the coils acts on the cells in this run; {}",
                                field.by_coils ? "field" : "controller: every command is zero",
                                field.by_coils ? "increase max_current of the coils" : controller_advice(s)));
    return;
  }
  for (std::size_t i = 0; i < s.swarms.size(); ++i) {
    if (s.swarms[i].params.responding == 0) continue;
    const WeakestField least =
        simulation.world().parts().populations[i].model->weakest_field(s.params.duration);
    if (!(field.tesla < least.tesla) || !std::isfinite(least.tesla)) continue;
    notes.push_back(fmt::format(
        "{}: the largest field is {:.3g} uT, but the cells of swarm[{}] need at least {:.3g} uT: {}; {}",
        field.by_coils ? "field" : "controller", field.tesla * 1e6, i, least.tesla * 1e6, least.reason,
        field.by_coils ? "increase limits.max_current and max_current of the coils" : controller_advice(s)));
  }
}

// A camera delay with which no command depends on its effect.
void note_delay(const Scenario& s, Notes& notes) {
  const double age = s.camera.delay_frames * s.frame_period();
  if (age > s.limits.max_frame_age)
    notes.push_back(
        fmt::format("camera.delay_frames is {}: every picture is {:.3g} s old, more than "
                    "limits.max_frame_age = {:g} s, and all "
                    "currents are zero; reduce the delay",
                    s.camera.delay_frames, age, s.limits.max_frame_age));
  else if (s.steers() && s.frames() > 1 && std::uint64_t(s.camera.delay_frames) >= s.frames())
    notes.push_back(
        fmt::format("camera.delay_frames is {}, but the run has {}: the controller gets only the "
                    "first picture; reduce "
                    "the delay or increase the duration",
                    s.camera.delay_frames, counted(s.frames(), "frame")));
}

// A drop, or a swarm, of which the camera sees nothing at the start.
void note_view(const Simulation& simulation, Notes& notes) {
  const World& world = simulation.world();
  const Frame f = simulation.frame();
  // The point of the view nearest to the centre of the arena.
  const Vec2 nearest{std::clamp(f.centre_image.x, -0.5, f.width - 0.5),
                     std::clamp(f.centre_image.y, -0.5, f.height - 0.5)};
  if (world.parts().arena->depth(f.world_from_image(nearest)) < 0) {
    notes.push_back(fmt::format(
        "arena: its centre is at {}, and no part of it is in the camera view of {} x {} px; move the centre "
        "towards the view, or increase its size",
        in_px(f.centre_image), f.width, f.height));
    return;
  }
  const auto x = world.state().agents["x"], y = world.state().agents["y"];
  const std::vector<Population>& swarms = world.parts().populations;
  for (std::size_t k = 0; k < swarms.size(); ++k) {
    std::size_t i = swarms[k].begin;
    while (i < swarms[k].end && !f.in_view(f.image_from_world({double(x[i]), double(y[i])}))) ++i;
    if (i < swarms[k].end) continue;
    notes.push_back(
        fmt::format("swarm[{}].start: no cell is in the camera view at the start; the camera sees only cells "
                    "that swim into "
                    "the view; start the swarm in the view of {} x {} px",
                    k, f.width, f.height));
  }
}

// Notes of the parts on their own parameters.
void note_parts(const Scenario& s, Notes& notes) {
  const auto add = [&](const std::string& where, const auto& part) {
    for (const std::string& text : part.notes) notes.push_back(fmt::format("{}: {}", where, text));
  };
  add("arena", s.arena);
  add("field", s.field);
  add("motility", s.motility);
  add("estimator", s.estimator);
  add("reference", s.reference);
  add("controller", s.controller);
  for (std::size_t i = 0; i < s.swarms.size(); ++i) {
    add(fmt::format("swarm[{}].model", i), s.swarms[i].model);
    add(fmt::format("swarm[{}].start", i), s.swarms[i].start);
  }
  for (std::size_t i = 0; i < s.events.size(); ++i) {
    if (s.events[i].model) add(fmt::format("event[{}].model", i), *s.events[i].model);
    if (s.events[i].controller) add(fmt::format("event[{}].controller", i), *s.events[i].controller);
  }
}

// Two swarms that the field cannot steer independently, or that the estimator does not separate.
void note_two_swarms(const Scenario& s, const Simulation& simulation, const TwoSwarmController& controller,
                     Notes& notes) {
  for (const std::string& text : controller.notes(simulation.reference().setpoints()))
    notes.push_back(fmt::format("controller: {}", text));
  if (s.estimator.has(Trait::needs_positions) || s.estimator.has(Trait::needs_pictures))
    notes.push_back(
        fmt::format("controller: it steers two swarms, but estimator \"{}\" does not separate them; use "
                    "the estimator of groups",
                    s.estimator.type));
}

void note_without_effect(const Scenario& s, const Simulation& simulation, Notes& notes) {
  if (s.limits.max_current == 0)
    notes.emplace_back("limits.max_current is 0: there is no current in the coils");
  if (std::all_of(s.swarms.begin(), s.swarms.end(), [](const Swarm& w) { return w.params.responding == 0; }))
    notes.emplace_back("responding is 0 for every swarm: no cell responds to the field");
  if (s.params.exposure > 0 && s.motility.has(Trait::inert))
    notes.push_back(fmt::format(
        "exposure is {:g} s, but has no effect with motility = \"{}\"; choose a motility law with an "
        "effect of air (faba parts motility)",
        s.params.exposure, s.motility.type));
  if (!s.renders() &&
      MicroscopeParams::schema().to_json(s.microscope) != MicroscopeParams::schema().to_json({}))
    notes.emplace_back(
        "microscope: has no effect without camera.sensor = \"frames\", record.as_seen = true (--as-seen) or "
        "record.flow = true");
  if (const double steps = s.frame_period() / simulation.step(); steps > 1e5)
    notes.push_back(fmt::format(
        "simulation: the models need {:.2g} steps per frame for their accuracy, which takes a long "
        "time; a weaker field, slower turning or less diffusion needs fewer",
        steps));
  if (s.frames() == 1)
    notes.push_back(fmt::format(
        "duration: the run has only one frame, at its start; at {:g} Hz the second frame is at {:g} s",
        s.camera.rate, s.frame_period()));
}

void note_recording(const Scenario& s, Notes& notes) {
  constexpr double kMaxDeviation = 0.4;  // frame periods, as in rig/simulated/sim_rig.cpp
  const double most = kMaxDeviation * s.frame_period();
  if (s.camera.jitter > most)
    notes.push_back(
        fmt::format("camera.jitter is {:g} s, but deviations of the frame times are limited to {:g} frame "
                    "periods ({:.3g} s); reduce the jitter or the frame rate",
                    s.camera.jitter, kMaxDeviation, most));
  if (s.record.as_seen && !s.record.video && !s.record.lossless)
    notes.emplace_back(
        "record.as_seen (--as-seen) has no effect: record.video and record.lossless are false; set one of "
        "them to true");
}

void note_part(const Scenario& s, Notes& notes) {
  const FrameRange part = s.recorded_frames();
  if (part.first == 0 && part.end == s.frames()) return;
  notes.push_back(fmt::format(
      "record.from, record.to: the files contain the part from {:g} s to {:g} s of a run of {:g} s; times "
      "count from the start of the run",
      double(part.first) * s.frame_period(), double(part.end) * s.frame_period(),
      double(s.frames()) * s.frame_period()));
}

void note_events(const Scenario& s, Notes& notes) {
  for (std::size_t i = 0; i < s.events.size(); ++i)
    if (s.events[i].frame >= s.frames())
      notes.push_back(
          fmt::format("event[{}].frame: {} is after the last frame of the run ({}); the event has no effect",
                      i, s.events[i].frame, s.frames() - 1));
}

std::string in_bytes(double bytes) {
  return bytes < 1e12 ? fmt::format("{:.3g} GB", bytes / 1e9) : fmt::format("{:.3g} TB", bytes / 1e12);
}

// Size of the positions: two floats or 16-bit integers per cell and frame; compression reduces it to three
// quarters or less.
void note_size(const Scenario& s, std::size_t cells, std::filesystem::path out, Notes& notes) {
  if (!s.record.tracks) return;
  constexpr double kCompressionRatio = 0.75, kLargeFile = 10e9;
  const double bytes = (s.record.resolution_px > 0 ? 4 : 8) * (s.record.compress ? kCompressionRatio : 1) *
                       double(cells) * double(s.frames()) / s.record.tracks_every;
  std::error_code ec;
  while (out.has_parent_path() && !std::filesystem::exists(out, ec)) out = out.parent_path();
  const auto disk = std::filesystem::space(std::filesystem::exists(out, ec) ? out : ".", ec);
  const bool fits = ec || bytes < double(disk.available);
  if (fits && bytes < kLargeFile) return;
  notes.push_back(fmt::format(
      "record: tracks.h5 will need about {}{}; increase tracks_every to keep fewer frames, or set tracks = "
      "false",
      in_bytes(bytes), fits ? "" : ", but the disk has only " + in_bytes(double(disk.available)) + " free"));
}

}  // namespace

std::string scale_note(const ScaleParams& p) {
  if (p.um_per_px) return {};
  return fmt::format(
      "scale: the scale of the picture is not known; a nominal {:g} um per px is used, and lengths are "
      "stated "
      "in px only; give scale.um_per_px, or scale.file, a calibration file of `faba scale`",
      p.used_um_per_px());
}

std::vector<std::string> scenario_notes(const Scenario& s, const Simulation& simulation,
                                        const std::filesystem::path& out) {
  Notes notes;
  note_parts(s, notes);
  if (std::string note = scale_note(s.scale); !note.empty()) notes.push_back(std::move(note));
  note_without_effect(s, simulation, notes);
  note_events(s, notes);
  note_recording(s, notes);
  note_part(s, notes);
  note_weak_field(s, simulation, notes);
  note_delay(s, notes);
  note_view(simulation, notes);
  if (s.steers()) {
    note_setpoints(s, simulation, notes);
    if (const auto* two = dynamic_cast<const TwoSwarmController*>(&simulation.controller()))
      note_two_swarms(s, simulation, *two, notes);
    else
      note_polarities(s, notes);
  }
  note_traps(s, simulation, notes);
  if (const auto& table = simulation.world().parts().table; table && table->error() > FieldTable::kTolerance)
    notes.push_back(
        fmt::format("library: the error of the field on its grid is up to {:.1g} of the maximum field of a "
                    "coil; a smaller "
                    "--spacing reduces it",
                    table->error()));
  note_currents(s, simulation, notes);
  note_size(s, simulation.world().state().agents.size(), out, notes);
  return notes;
}

}  // namespace faba
