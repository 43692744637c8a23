#include "app/run/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/run/steering_notes.h"
#include "core/counted.h"

namespace faba {
namespace {

using Notes = std::vector<std::string>;

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
        "arena: its centre is at ({:.0f}, {:.0f}) px, and no part of it is in the camera view of {} x {} px; "
        "move the centre towards the view, or increase its size",
        f.centre_image.x, f.centre_image.y, f.width, f.height));
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
  add_steering_notes(s, simulation, notes);
  if (const auto& table = simulation.world().parts().table; table && table->error() > FieldTable::kTolerance)
    notes.push_back(
        fmt::format("library: the error of the field on its grid is up to {:.1g} of the maximum field of a "
                    "coil; a smaller "
                    "--spacing reduces it",
                    table->error()));
  note_size(s, simulation.world().state().agents.size(), out, notes);
  return notes;
}

}  // namespace faba
