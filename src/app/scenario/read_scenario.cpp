#include "app/scenario/read_scenario.h"

#include <fmt/format.h>

#include "app/scenario/calibration_file.h"
#include "app/scenario/read_event.h"
#include "app/scenario/rig_file.h"
#include "core/hash.h"
#include "field/library.h"

namespace faba {
namespace {

template <class P>
void section(const Node& root, const char* key, P& out, const Schema<P>& schema) {
  if (root.has(key)) out = schema.parse(root.child(key));
}

template <class Registry>
auto part(const Node& root, const char* key, const Registry& registry, const Json& fallback) {
  if (root.has(key)) return registry.resolve(root.child(key));
  return registry.resolve(Node(fallback, key, root.document));
}

void read_library(const Node& root, Scenario& s) {
  if (!root.has("library")) return;
  const Node n = root.child("library");
  LibraryParams p = LibraryParams::schema().parse(n);
  p.file = std::filesystem::absolute(n.file(p.file)).lexically_normal().string();
  Hash h;
  h.text(FieldLibrary::task(p.file));
  if (!p.made.empty() && p.made != h.hex())
    throw Error(Errc::input, p.file, "is another library than the one that this scenario was made with");
  p.made = h.hex();
  s.library = p;
}

void read_swarms(const Node& root, const Parts& parts, Scenario& s) {
  if (!root.has("swarm")) root.fail("needs at least one [[swarm]]");
  const Node list = root.child("swarm");
  if (!list.json->is_array() || list.json->empty()) list.fail("write [[swarm]], once for each kind of cell");
  double total = 0;
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    Swarm one;
    one.params = Swarm::schema().parse(n, {"model", "start"});
    one.model = part(n, "model", parts.model, "dipole");
    one.start = part(n, "start", parts.start, "uniform");
    // nested parts know only their own key: say where they stand
    total += double(one.params.count);
    s.swarms.push_back(std::move(one));
  }
  if (total > 5e7) list.fail(fmt::format("{} cells in all; at most 5e7 are possible", total));
}

}  // namespace

// Without feedback nobody needs to know where the cells are.
const char* usual_estimator(const Scenario& s) {
  if (s.camera.sensor == CameraParams::Sensor::positions) return "mean";
  return s.steers() ? "image" : "none";
}

void check_control(const Node& root, const Scenario& s) {
  if (s.steers() && s.estimator.type == "none")
    throw Error(Errc::usage, root.where("estimator"),
                fmt::format("controller {} steers by an estimate, and \"none\" gives it none; use \"{}\"",
                            s.controller.type, usual_estimator(s)));
  if (s.camera.sensor == CameraParams::Sensor::positions && s.estimator.type == "image")
    throw Error(Errc::usage, root.where("estimator"),
                "\"image\" looks at pictures, and a camera with sensor = \"positions\" takes none; set "
                "camera.sensor = \"frames\"");
  if (s.camera.sensor == CameraParams::Sensor::frames &&
      (s.estimator.type == "mean" || s.estimator.type == "visible"))
    throw Error(
        Errc::usage, root.where("estimator"),
        fmt::format("\"{}\" needs the position of every cell, and a camera with sensor = \"frames\" tells "
                    "none; use \"image\" or \"groups\"",
                    s.estimator.type));
  if (s.steers() && s.reference.type == "none")
    throw Error(
        Errc::usage, root.where("reference"),
        fmt::format("controller {} has nowhere to steer to; use \"hold\" or \"route\"", s.controller.type));
}

namespace {

// In TOML a key belongs to the last [header] before it, which is easily forgotten below the tables.
void check_top_level(const Node& root) {
  for (const auto& [table, content] : root.json->items()) {
    const bool list = content.is_array() && !content.empty();
    const Node n = list ? root.child(table).item(content.size() - 1) : root.child(table);
    for (const char* key : {"title", "seed", "duration"})
      if (n.json->is_object() && n.json->contains(key))
        throw Error(Errc::usage, n.where(key),
                    fmt::format("belongs to the whole scenario; write {} above the first [table]", key));
  }
}

}  // namespace

Scenario read_scenario(Document d, const Parts& parts) {
  include_rig(d);
  include_calibration(d);
  const Node root(d);
  check_top_level(root);
  Scenario s;
  s.params =
      Scenario::schema().parse(root, {"scale", "camera", "microscope", "simulation", "arena", "exclusion",
                                      "field", "motility", "swarm", "estimator", "reference", "controller",
                                      "limits", "library", "record", "flow", "event", "rig"});
  section(root, "scale", s.scale, ScaleParams::schema());
  section(root, "camera", s.camera, CameraParams::schema());
  section(root, "microscope", s.microscope, MicroscopeParams::schema());
  section(root, "simulation", s.simulation, SimulationParams::schema());
  section(root, "limits", s.limits, Limits::schema());
  section(root, "exclusion", s.exclusion, Exclusion::schema());
  section(root, "record", s.record, Record::schema());
  s.arena = part(root, "arena", parts.arena, "box");
  s.field = part(root, "field", parts.field, "uniform");
  s.motility = part(root, "motility", parts.motility, "none");
  s.controller = part(root, "controller", parts.controller, "fuzzy");
  s.estimator = part(root, "estimator", parts.estimator, usual_estimator(s));
  s.reference = part(root, "reference", parts.reference, s.steers() ? "hold" : "none");
  s.flow = part(root, "flow", parts.flow, {{"type", "horn_schunck"}, {"preset", "published"}});
  read_swarms(root, parts, s);
  read_library(root, s);
  if (root.has("rig"))
    s.rig = RigSetup::read(root.child("rig"), s.field.make({})->coils(), parts.camera, parts.driver);
  if (!s.microscope.background.empty())
    s.microscope.background =
        std::filesystem::absolute(root.child("microscope").file(s.microscope.background))
            .lexically_normal()
            .string();
  check_control(root, s);

  if (s.params.duration * s.camera.rate > 1e8)
    root.child("duration").fail("is more than 1e8 frames; shorten it or lower camera.rate");
  if (s.arena.resolved.value("limits", "") == "reject" && s.exclusion.order == Exclusion::Order::none)
    throw Error(Errc::usage, root.where("arena"),
                "limits = \"reject\" needs exclusion; use \"clamp\" or \"reflect\"");
  if (!root.has("event")) return s;
  const Node events = root.child("event");
  if (!events.json->is_array()) events.fail("write [[event]], once for each change");
  Scenario now = s;
  for (std::size_t i = 0; i < events.json->size(); ++i) {
    const Node n = events.item(i);
    s.events.push_back(read_event(n, now, parts));
    if (i > 0 && s.events[i].frame < s.events[i - 1].frame)
      n.child("frame").fail("events must be in order of time");
  }
  return s;
}

}  // namespace faba
