#include "app/run/steering_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "control/plan/obstacles.h"
#include "control/two_swarms.h"
#include "field/null.h"

namespace faba {
namespace {

using SteeringNotes = std::vector<std::string>;

constexpr std::size_t kListedSetpoints = 50;  // more are a curve, for which one note is enough

void note_setpoints(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
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

void note_polarities(const Scenario& s, SteeringNotes& notes) {
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
void note_traps(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
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
void note_currents(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
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

// Two swarms that do not exist, that differ from the expected ones, that the estimator does not separate, or
// of which the second cannot reach its setpoint.
void note_two_swarms(const Scenario& s, const Simulation& simulation, const TwoSwarmController& controller,
                     SteeringNotes& notes) {
  if (s.swarms.size() == 1)
    notes.push_back(
        fmt::format("controller: \"{}\" steers two swarms, but the scenario has one [[swarm]]; add a second "
                    "one, or choose another controller",
                    s.controller.type));
  if (s.estimator.has(Trait::needs_positions) || s.estimator.has(Trait::needs_pictures))
    notes.push_back(
        fmt::format("controller: it steers two swarms, but estimator \"{}\" does not separate them; use "
                    "the estimator of groups",
                    s.estimator.type));
  if (s.swarms.size() == 2) {
    const bool opposite = s.swarms[0].params.polarity != s.swarms[1].params.polarity;
    if (opposite && !controller.opposite())
      notes.emplace_back(
          "controller.second_polarity is \"same\", but the swarms of the scenario have opposite polarity; "
          "set it to \"opposite\"");
    if (!opposite && controller.opposite())
      notes.emplace_back(
          "controller.second_polarity is \"opposite\", but the swarms of the scenario have the same "
          "polarity; set it to \"same\"");
  }
  const std::optional<Vec2> second = controller.second_setpoint();
  if (second && simulation.world().parts().arena->depth(*second) < 0)
    notes.push_back(fmt::format(
        "controller.second_px: the setpoint {} is outside the {}; the second swarm cannot reach it",
        in_px(simulation.frame().image_from_world(*second)), s.arena.type));
}

// Whether all fields are along one line. A coil whose field is a hundredth of the strongest one does not
// count.
bool along_one_line(std::span<const Vec3> fields) {
  constexpr double kParallel = 0.1, kWeak = 0.01;  // sine of an angle; fraction of the strongest field
  Vec2 strongest;
  for (const Vec3 b : fields)
    if (std::hypot(b.x, b.y) > norm(strongest)) strongest = {b.x, b.y};
  const double most = norm(strongest);
  return most > 0 && std::isfinite(most) && std::all_of(fields.begin(), fields.end(), [&](const Vec3 b) {
           const double own = std::hypot(b.x, b.y);
           return own <= kWeak * most ||
                  std::fabs(b.x * strongest.y - b.y * strongest.x) <= kParallel * own * most;
         });
}

// Coils that cannot move a swarm in every direction at a setpoint.
void note_one_direction(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
  if (!s.controller.has(Trait::feedback)) return;
  const Field& field = *simulation.world().parts().field;
  std::vector<Vec3> b(field.coils());
  for (const Vec2 at : simulation.reference().setpoints()) {
    field.basis({at.x, at.y, 0}, b, {});
    if (!along_one_line(b)) continue;
    notes.push_back(fmt::format(
        "controller: at {} the fields of all coils are nearly along one line, so that the swarm can hardly "
        "be steered perpendicular to it; use coils in two directions, as in rigs/thesis-four-coils.toml",
        in_px(simulation.frame().image_from_world(at))));
    return;
  }
}

Vec2 mean_at_start(const Simulation& simulation) {
  const Columns& cells = simulation.world().state().agents;
  const auto x = cells["x"], y = cells["y"];
  Vec2 sum;
  for (std::size_t i = 0; i < x.size(); ++i) sum = sum + Vec2{double(x[i]), double(y[i])};
  return (1 / double(x.size())) * sum;
}

// Obstacles in which the swarm starts, that enclose it or its first setpoint, or around which the shortest
// way, which the controller takes, leads outside of the arena.
void note_obstacles(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
  const std::vector<Polygon> obstacles = simulation.controller().obstacles();
  const std::vector<Vec2> setpoints = simulation.reference().setpoints();
  if (obstacles.empty() || setpoints.empty() || simulation.world().state().agents.size() == 0) return;
  const Vec2 start = mean_at_start(simulation);
  for (const Polygon& polygon : obstacles)
    if (nearest_edge(polygon, start).distance < 0) {
      notes.emplace_back(
          "controller: the mean of the swarm starts in an obstacle, from which it moves out first; move the "
          "obstacle or the start of the swarm");
      return;
    }
  const Arena& arena = *simulation.world().parts().arena;
  const std::vector<Vec2> way = shortest_path(obstacles, start, setpoints.front(), 0);
  const bool blocked =
      way.size() == 1 && std::any_of(obstacles.begin(), obstacles.end(),
                                     [&](const Polygon& p) { return crosses(p, start, setpoints.front()); });
  const bool outside = std::any_of(way.begin(), way.end() - 1, [&](Vec2 p) { return arena.depth(p) < 0; });
  if (blocked)
    notes.emplace_back(
        "controller: the obstacles leave no way from the start of the swarm to its first setpoint; leave a "
        "gap");
  if (outside)
    notes.push_back(fmt::format(
        "controller: the shortest way around the obstacles from the start of the swarm to its first setpoint "
        "leads outside of the {}, where the swarm cannot follow; shorten or move an obstacle",
        s.arena.type));
}

}  // namespace

void add_steering_notes(const Scenario& s, const Simulation& simulation, SteeringNotes& notes) {
  if (s.steers()) {
    note_setpoints(s, simulation, notes);
    for (const std::string& text : simulation.controller().notes(simulation.reference().setpoints()))
      notes.push_back(fmt::format("controller: {}", text));
    note_one_direction(s, simulation, notes);
    note_obstacles(s, simulation, notes);
    if (const auto* two = dynamic_cast<const TwoSwarmController*>(&simulation.controller()))
      note_two_swarms(s, simulation, *two, notes);
    else
      note_polarities(s, notes);
  }
  note_traps(s, simulation, notes);
  note_currents(s, simulation, notes);
}

}  // namespace faba
