#include "app/run/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "field/null.h"

namespace faba {
namespace {

using Notes = std::vector<std::string>;

// Currents in A from a resolved scenario: "0.5 A".
std::vector<double> currents_in(const Json& list) {
  std::vector<double> a;
  for (const Json& one : list)
    a.push_back(one.is_string() ? parse_quantity(one.get<std::string>()).value : one.get<double>());
  return a;
}

void note_setpoints(const Simulation& simulation, Notes& notes) {
  const Arena& arena = *simulation.world().parts().arena;
  for (const Vec2 at : simulation.reference().setpoints()) {
    const Vec2 px = simulation.frame().image_from_world(at);
    if (arena.depth(at) >= 0) {
      if (!simulation.frame().in_view(px))
        notes.push_back(
            fmt::format("reference: the setpoint ({:g}, {:g}) px is outside the camera view", px.x, px.y));
      continue;
    }
    notes.push_back(
        fmt::format("reference: the setpoint ({:g}, {:g}) px is outside the {}; the swarm cannot reach it",
                    px.x, px.y, arena.outline().radius_px > 0 ? "drop" : "box"));
  }
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

// Whether the zeros of a gradient controller are reachable and trap cells.
void note_traps(const Scenario& s, const Simulation& simulation, Notes& notes) {
  const Field& field = *simulation.world().parts().field;
  const std::vector<double> limits = field.max_currents(s.limits.max_current);
  for (const Vec2 at : simulation.reference().setpoints()) {
    const FieldNull n = null_at(field, at, s.polarity(), limits);
    const std::string position = in_px(simulation.frame().image_from_world(at));
    if (!n.reachable)
      notes.push_back(
          fmt::format("controller: these coils cannot produce a zero of the field at {}; the swarm does not "
                      "gather there",
                      position));
    else if (n.saddle)
      notes.push_back(fmt::format("controller: the zero of the field at {} is {}", position, kSaddle));
  }
}

// Zero of the field near the sample for currents given per coil, and its effect on cells.
void note_currents(const Scenario& s, const Simulation& simulation, Notes& notes) {
  const WorldParts& parts = simulation.world().parts();
  const auto check_zero = [&](const Json& from) {
    const std::vector<double> current =
        from.value("current", Json::array()).empty() ? std::vector<double>() : currents_in(from["current"]);
    if (current.empty()) return;
    const Vec2 at = find_null(*parts.field, current, {});
    if (!std::isfinite(at.x) || parts.field->clearance({at.x, at.y, 0}) < 1e-4) return;
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
  };
  check_zero(s.controller.resolved);
  for (const Json& segment : s.controller.resolved.value("segment", Json::array())) check_zero(segment);
}

void note_without_effect(const Scenario& s, const Simulation& simulation, Notes& notes) {
  if (s.limits.max_current == 0)
    notes.emplace_back("limits.max_current is 0: there is no current in the coils");
  if (std::all_of(s.swarms.begin(), s.swarms.end(), [](const Swarm& w) { return w.params.responding == 0; }))
    notes.emplace_back("responding is 0 for every swarm: no cell responds to the field");
  if (s.params.exposure > 0 && s.motility.has(Trait::inert))
    notes.emplace_back(
        "exposure has no effect with motility = \"none\"; did you mean motility = \"thesis\"?");
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

std::string in_bytes(double bytes) {
  return bytes < 1e12 ? fmt::format("{:.3g} GB", bytes / 1e9) : fmt::format("{:.3g} TB", bytes / 1e12);
}

// Size of the positions: two floats per cell and frame; compression reduces it to three quarters.
void note_size(const Scenario& s, std::size_t cells, std::filesystem::path out, Notes& notes) {
  if (!s.record.tracks) return;
  constexpr double kBytesPerCell = 8, kCompressionRatio = 0.75, kLargeFile = 10e9;
  const double bytes = kBytesPerCell * (s.record.compress ? kCompressionRatio : 1) * double(cells) *
                       double(s.frames()) / s.record.tracks_every;
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

std::vector<std::string> scenario_notes(const Scenario& s, const Simulation& simulation,
                                        const std::filesystem::path& out) {
  Notes notes;
  note_without_effect(s, simulation, notes);
  if (s.steers()) {
    note_setpoints(simulation, notes);
    note_polarities(s, notes);
  }
  if (s.controller.has(Trait::seeks_null)) note_traps(s, simulation, notes);
  if (const auto& table = simulation.world().parts().table; table && table->error() > FieldTable::kTolerance)
    notes.push_back(
        fmt::format("library: the error of the field on its grid is up to {:.1g} of the maximum field of a "
                    "coil; a smaller "
                    "--spacing reduces it",
                    table->error()));
  if (s.controller.has(Trait::open_loop)) note_currents(s, simulation, notes);
  note_size(s, simulation.world().state().agents.size(), out, notes);
  return notes;
}

}  // namespace faba
