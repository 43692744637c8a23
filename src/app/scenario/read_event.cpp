#include "app/scenario/read_event.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/scenario/control_rules.h"
#include "core/counted.h"

namespace faba {
namespace {

const std::vector<std::string> kParts = {"model", "estimator", "reference", "controller"};

}  // namespace

void change(const Event& e, Scenario& s) {
  if (e.model) s.swarms.at(e.swarm).model = *e.model;
  if (e.estimator) s.estimator = *e.estimator;
  if (e.reference) s.reference = *e.reference;
  if (e.controller) s.controller = *e.controller;
}

Event read_event(const Node& n, Scenario& now, const Parts& parts) {
  const EventTime when = EventTime::schema().parse(n, kParts);
  if (std::none_of(kParts.begin(), kParts.end(), [&](const std::string& key) { return n.has(key); }))
    n.fail(
        fmt::format("names no part; add at least one of the keys {}, and the key frame with the frame before "
                    "which the part is exchanged",
                    fmt::join(kParts, ", ")));
  Event e;
  e.frame = when.frame;
  e.swarm = std::size_t(when.swarm);
  if (n.has("model")) {
    if (e.swarm >= now.swarms.size())
      n.child("swarm").fail(fmt::format("{} is out of range; the scenario has {}, and the first swarm is 0",
                                        e.swarm, counted(now.swarms.size(), "swarm")));
    e.model = parts.model.resolve(n.child("model"));
  }
  if (n.has("estimator")) e.estimator = parts.estimator.resolve(n.child("estimator"));
  if (n.has("reference")) e.reference = parts.reference.resolve(n.child("reference"));
  if (n.has("controller")) e.controller = parts.controller.resolve(n.child("controller"));

  Scenario next = now;
  change(e, next);
  if (next.steers()) {
    const auto default_part = [&](const auto& registry, const char* kind, const Json& name) {
      return registry.resolve(Node(name, kind, n.document));
    };
    if (!e.estimator && next.estimator.has(Trait::no_estimate))
      e.estimator = default_part(parts.estimator, "estimator", next.default_estimator());
    if (!e.reference && next.reference.has(Trait::no_target))
      e.reference = default_part(parts.reference, "reference", next.default_reference());
    change(e, next);
  }
  check_control(n, next, parts);
  now = std::move(next);
  return e;
}

void read_events(const Node& root, const Parts& parts, Scenario& s) {
  const Node events = root.child("event");
  if (!events.json->is_array()) events.fail("must be an array of tables; write [[event]] for each change");
  Scenario now = s;
  for (std::size_t i = 0; i < events.json->size(); ++i) {
    const Node n = events.item(i);
    s.events.push_back(read_event(n, now, parts));
    if (i > 0 && s.events[i].frame < s.events[i - 1].frame)
      n.child("frame").fail("events must be in the order of their frames");
  }
}

}  // namespace faba
