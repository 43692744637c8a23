#include "app/scenario/read_event.h"

#include <fmt/format.h>

#include "app/scenario/read_scenario.h"

namespace faba {
namespace {

struct When {
  std::uint64_t frame = 0;
  std::uint64_t swarm = 0;
  static Schema<When> schema() {
    return Schema<When>("event", "Parts that are exchanged while the run goes on")
        .add("frame", &When::frame,
             {.min = 0, .max = 1e9, .doc = "Before this frame; the run begins with frame 0"})
        .add("swarm", &When::swarm, {.min = 0, .max = 1e6, .doc = "Whose model it is, from 0 on"});
  }
};

const std::vector<std::string> kParts = {"model", "estimator", "reference", "controller"};

}  // namespace

void change(const Event& e, Scenario& s) {
  if (e.model) s.swarms.at(e.swarm).model = *e.model;
  if (e.estimator) s.estimator = *e.estimator;
  if (e.reference) s.reference = *e.reference;
  if (e.controller) s.controller = *e.controller;
}

Event read_event(const Node& n, Scenario& now, const Parts& parts) {
  const When when = When::schema().parse(n, kParts);
  Event e;
  e.frame = when.frame, e.swarm = std::size_t(when.swarm);
  if (n.has("model")) {
    if (e.swarm >= now.swarms.size())
      n.child("swarm").fail(fmt::format("there are {} swarms, counted from 0 on", now.swarms.size()));
    e.model = parts.model.resolve(n.child("model"));
  }
  if (n.has("estimator")) e.estimator = parts.estimator.resolve(n.child("estimator"));
  if (n.has("reference")) e.reference = parts.reference.resolve(n.child("reference"));
  if (n.has("controller")) e.controller = parts.controller.resolve(n.child("controller"));

  Scenario next = now;
  change(e, next);
  if (next.steers()) {
    const auto usual = [&](const auto& registry, const char* kind, const char* name) {
      const Json word = name;
      return registry.resolve(Node(word, kind, n.document));
    };
    if (!e.estimator && next.estimator.type == "none")
      e.estimator = usual(parts.estimator, "estimator", usual_estimator(next));
    if (!e.reference && next.reference.type == "none")
      e.reference = usual(parts.reference, "reference", "hold");
    change(e, next);
  }
  check_control(n, next);
  now = std::move(next);
  return e;
}

Json event_json_schema() { return When::schema().json_schema(); }

}  // namespace faba
