#include "app/notes.h"

#include <fmt/format.h>

#include <algorithm>

namespace faba {
namespace {

using Notes = std::vector<std::string>;

void note_goals(const Simulation& simulation, Notes& notes) {
  const Arena& arena = *simulation.world().parts().arena;
  for (const Vec2 at : simulation.reference().setpoints()) {
    if (arena.depth(at) >= 0) continue;
    const Vec2 px = simulation.frame().image_from_world(at);
    notes.push_back(fmt::format(
        "reference: the setpoint ({:g}, {:g}) px lies outside of the {}; the swarm cannot get there", px.x,
        px.y, arena.outline().radius_px > 0 ? "drop" : "box"));
  }
}

void note_polarities(const Scenario& s, Notes& notes) {
  const bool north = s.polarity() > 0;
  for (std::size_t i = 0; i < s.swarms.size(); ++i) {
    if ((s.swarms[i].params.polarity == Swarm::Polarity::north) == north) continue;
    notes.push_back(
        fmt::format("swarm[{}]: the controller steers the {}-seeking cells; what draws them to the setpoint "
                    "drives these away",
                    i, north ? "north" : "south"));
  }
}

void note_helpless(const Scenario& s, Notes& notes) {
  if (s.limits.max_current == 0)
    notes.emplace_back("limits.max_current is 0: the coils stay without current");
  if (std::all_of(s.swarms.begin(), s.swarms.end(), [](const Swarm& w) { return w.params.responding == 0; }))
    notes.emplace_back("responding is 0 for every swarm: no cell feels the field");
  if (s.params.exposure > 0 && s.motility.type == "none")
    notes.emplace_back(
        "exposure has no effect with motility = \"none\"; did you mean motility = \"thesis\"?");
  if (s.frames() == 1)
    notes.push_back(
        fmt::format("duration: the run has one frame, its beginning; at {:g} Hz the next one comes "
                    "after {:g} s",
                    s.camera.rate, s.frame_period()));
}

std::string in_bytes(double bytes) {
  return bytes < 1e12 ? fmt::format("{:.3g} GB", bytes / 1e9) : fmt::format("{:.3g} TB", bytes / 1e12);
}

// Positions are what grows: two floats for every cell and frame, of which compression leaves three quarters.
void note_size(const Scenario& s, std::size_t cells, std::filesystem::path out, Notes& notes) {
  if (!s.record.tracks) return;
  constexpr double kBytesPerCell = 8, kLeftByCompression = 0.75, kMuch = 10e9;
  const double bytes = kBytesPerCell * (s.record.compress ? kLeftByCompression : 1) * double(cells) *
                       double(s.frames()) / s.record.tracks_every;
  std::error_code ec;
  while (out.has_parent_path() && !std::filesystem::exists(out, ec)) out = out.parent_path();
  const auto disk = std::filesystem::space(std::filesystem::exists(out, ec) ? out : ".", ec);
  const bool fits = ec || bytes < double(disk.available);
  if (fits && bytes < kMuch) return;
  notes.push_back(fmt::format(
      "record: tracks.h5 will take about {}{}; a larger tracks_every keeps fewer "
      "frames, tracks = false none",
      in_bytes(bytes), fits ? "" : ", and the disk has " + in_bytes(double(disk.available)) + " left"));
}

}  // namespace

std::vector<std::string> notes_on(const Scenario& s, const Simulation& simulation,
                                  const std::filesystem::path& out) {
  Notes notes;
  note_helpless(s, notes);
  if (s.steers()) {
    note_goals(simulation, notes);
    note_polarities(s, notes);
  }
  note_size(s, simulation.world().state().agents.size(), out, notes);
  return notes;
}

}  // namespace faba
