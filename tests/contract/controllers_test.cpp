// Controllers without the limits of the control loop.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/contract/contract.h"
#include "tests/reference_rig.h"

#include "field/library.h"

using namespace faba;
using contract::Findings;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kFrame = 1.0 / 15;  // s
constexpr Target kTarget{{2e-4, -1e-4}, 0, false};

Estimate estimate_at(Vec2 at, double visible = 100) {
  Estimate e;
  e.centroid = at;
  e.visible = visible;
  return e;
}
const Estimate kGood = estimate_at({-1e-4, 5e-5});

/// Context with a uniform field, or with the four coils of the reference rig, which have field zeros.
ControlContext context_for(const std::string& field) {
  ControlContext c;
  const std::string rig = "[f]\ntype = 'rig'\nearth = { field = ['18 uT', '-9 uT', 0] }\n" +
                          reference_coils("f.coil", {0, 90, 180, 270});
  const Document d = parse_toml(field == "rig" ? rig : "f = 'uniform'", "test");
  c.field = contract::parts().field.resolve(Node(d).child("f")).make({});
  c.frame_period = kFrame;
  c.delay_frames = 1;
  c.max_current = c.field->max_currents(2);
  FieldLibrary::Content library;
  library.grid = {{-1e-3, -1e-3}, 1e-3, 3, 3};
  for (const double x : {-1e-4, 3e-4})
    library.entries.push_back({std::vector<double>(c.field->coils(), 1e3 * x), {x, 0}, {0.1, 0.2}});
  library.field = [](std::size_t) { return std::vector<float>(18); };
  c.library = std::make_shared<FieldLibrary>(std::move(library));
  return c;
}

/// The context for a controller: with cells that do not move, or, if it refuses these, with cells that turn.
/// With the latter `mpc` would plan for minutes.
ControlContext context_for(const std::string& field, const std::string& controller) {
  ControlContext c = context_for(field);
  try {
    contract::resolved(contract::parts().controller, controller).make(c);
  } catch (const Error&) {
    c.motion = {.speed = 186e-6, .turning = 1.3e5, .diffusion = 0.54};
  }
  return c;
}

bool finite(const Command& c) {
  return std::all_of(c.current.begin(), c.current.end(), [](double i) { return std::isfinite(i); });
}
bool zero(const Command& c) {
  return std::all_of(c.current.begin(), c.current.end(), [](double i) { return i == 0; });
}

/// Invalid or extreme estimates and targets.
struct Hostile {
  std::string what;
  Estimate estimate;
  Target target = kTarget;
  bool unseen = false;  ///< based on no cells, or not a finite position
};

std::vector<Hostile> hostile_inputs() {
  std::vector<Hostile> all{{"an empty estimate", {}, kTarget, true}};
  for (const double bad : {0.0, kNan, kInf, -kInf, 1e300, -1e300, 1e150, 1e30, 1e5, 1e-300})
    for (const Vec2 at : {Vec2{bad, -bad}, Vec2{bad, 0}, Vec2{0, bad}, Vec2{bad, bad}}) {
      const std::string where = fmt::format("({}, {})", at.x, at.y);
      for (const double visible : {0.0, 1e-300, 100.0, 1e300, kInf, kNan})
        all.push_back({fmt::format("centroid {}, visible {}", where, visible), estimate_at(at, visible),
                       kTarget, !(visible > 0) || !std::isfinite(bad)});
      all.push_back({"target " + where, kGood, {at, 0, false}});
      all.push_back({"target and centroid " + where, estimate_at(at), {at, 0, false}});
      Estimate e = kGood;
      e.velocity = at;
      e.cov = {bad, bad, bad};
      all.push_back({"velocity " + where, e});
    }
  return all;
}

using ControllerPart = ControllerRegistry::PartType;

/// A controller after an update with a valid estimate; `last` is its last command.
struct Started {
  std::unique_ptr<Controller> controller;
  Command last;
  Started(const ControllerPart& part, const ControlContext& c) : controller(part.make(c)) { take(kGood); }
  Command take(const Estimate& e, const Target& target = kTarget) {
    return last = controller->update(e, target, kFrame);
  }
};

Findings faults_of_command(const Command& c, const ControlContext& context) {
  if (c.current.size() != context.field->coils())
    return {fmt::format("{} currents for {} coils", c.current.size(), context.field->coils())};
  if (!finite(c)) return {fmt::format("currents {}", fmt::join(c.current, ", "))};
  return {};
}

/// Feedback: an estimate without cells must not move the swarm, and must not have an effect later.
Findings faults_when_unseen(const ControllerPart& part, const ControlContext& context, const Hostile& h) {
  Findings found;
  Started started(part, context), blind(part, context);
  const Command before = started.last, now = started.take(h.estimate, h.target);
  if (part.has(Trait::seeks_null) ? now.current != before.current : !zero(now))
    found.push_back(fmt::format("moves the swarm: currents {} after {}", fmt::join(now.current, ", "),
                                fmt::join(before.current, ", ")));
  blind.take(estimate_at(kGood.centroid, 0));
  for (int i = 0; i < 5; ++i) {
    const Estimate e = estimate_at((1 - 0.1 * i) * kGood.centroid);
    if (started.take(e).current == blind.take(e).current) continue;
    found.push_back(fmt::format("has an effect {} frames later", i + 1));
    break;
  }
  return found;
}

/// Contract violations of a controller for all hostile estimates and targets.
Findings faults_of_controller(const ControllerPart& part, const ControlContext& context) {
  Findings found;
  const auto add = [&](const std::string& when, const Findings& more) {
    for (const std::string& f : more) found.push_back(fmt::format("{}: {}", when, f));
  };
  for (const Hostile& h : hostile_inputs()) {
    add(h.what + ", at once",
        faults_of_command(part.make(context)->update(h.estimate, h.target, kFrame), context));
    Started started(part, context);
    add(h.what, faults_of_command(started.take(h.estimate, h.target), context));
    add("a valid estimate after " + h.what, faults_of_command(started.take(kGood), context));
    if (h.unseen && part.has(Trait::feedback)) add(h.what, faults_when_unseen(part, context, h));
  }
  return found;
}

/// The part with its defaults, and with each choice and range end that is permitted with this context.
std::vector<ControllerPart> variants(const std::string& name, const ControlContext& context) {
  const auto& registry = contract::parts().controller;
  std::vector<ControllerPart> all{contract::resolved(registry, name)};
  if (std::getenv("FABA_DEFAULTS_ONLY")) return all;  // under emulation, where all variants take an hour
  const auto add = [&](const std::string& key, const Json& value) {
    try {
      const ControllerPart part = contract::resolved(registry, Json{{"type", name}, {key, value}});
      part.make(context);
      all.push_back(part);
    } catch (const Error&) {  // rules over several keys, listed in ranges_test.cpp, or over the context
    }
  };
  const Json properties = registry.json_schema(name)["properties"];
  for (const auto& [key, field] : properties.items()) {
    for (const char* end : {"minimum", "maximum"})
      if (field.contains(end)) add(key, field[end]);
    if (field.contains("enum"))
      for (const Json& choice : field["enum"]) add(key, choice);
  }
  return all;
}

/// Deliberately faulty: NaN where other controllers command zero.
struct NanController final : Controller {
  struct Params {};
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema() { return {"nan", "NaN for an invalid estimate"}; }
  NanController(const Params&, const ControlContext& c) : coils(c.field->coils()) {}
  Command update(const Estimate& e, const Target&, double) override {
    return {std::vector<double>(coils, std::isfinite(e.centroid.x) ? 0.0 : kNan)};
  }
  std::size_t coils;
};
/// Deliberately faulty: non-zero current without a valid estimate.
struct BlindController final : Controller {
  struct Params {};
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema() { return {"blind", "Constant command, independent of the estimate"}; }
  BlindController(const Params&, const ControlContext& c) : coils(c.field->coils()) {}
  Command update(const Estimate&, const Target&, double) override {
    return {std::vector<double>(coils, 0.1)};
  }
  std::size_t coils;
};
/// Deliberately faulty: one current too few.
struct ShortController final : Controller {
  struct Params {};
  static Schema<Params> schema() { return {"short", "One current too few"}; }
  ShortController(const Params&, const ControlContext& c) : coils(c.field->coils()) {}
  Command update(const Estimate&, const Target&, double) override {
    return {std::vector<double>(coils - 1, 0.0)};
  }
  std::size_t coils;
};

template <class T>
ControllerPart deliberately_faulty() {
  ControllerRegistry registry("controller", "Deliberately faulty");
  registry.add<T>();
  return contract::resolved(registry, registry.names().front());
}

}  // namespace

TEST_CASE("every controller: one finite current for each coil; no current for unseen or invalid estimates") {
  for (const std::string field : {"uniform", "rig"}) {
    for (const auto& name : contract::parts().controller.names()) {
      const ControlContext context = context_for(field, name);
      for (const ControllerPart& part : variants(name, context)) {
        INFO(field, ": ", part.resolved.dump());
        CHECK_NO_FINDINGS(faults_of_controller(part, context));
      }
    }
  }
}

TEST_CASE("no controller commands a field above its max_field()") {
  for (const auto& name : contract::parts().controller.names()) {
    const ControlContext context = context_for("uniform", name);
    for (const ControllerPart& part : variants(name, context)) {
      INFO(part.resolved.dump());
      for (const Hostile& h : hostile_inputs()) {
        Started started(part, context);
        const double most = started.controller->max_field() * (1 + 1e-9);
        for (const Command& c : {started.last, started.take(h.estimate, h.target)})
          CHECK_MESSAGE(norm(context.field->at({}, c.current)) <= most, h.what);
      }
    }
  }
}

TEST_CASE("every controller with feedback acts on a valid estimate (validity of the checks above)") {
  for (const auto& name : contract::parts().controller.names_with(Trait::feedback)) {
    INFO(name);
    CHECK_FALSE(
        zero(Started(contract::resolved(contract::parts().controller, name), context_for("rig", name)).last));
  }
}

TEST_CASE("deliberately faulty controllers are detected") {
  const auto found = [](const ControllerPart& part, const std::string& what) {
    const Findings all = faults_of_controller(part, context_for("uniform"));
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& f) { return f.find(what) != std::string::npos; });
  };
  CHECK(found(deliberately_faulty<NanController>(), "visible 100: currents nan, nan"));
  CHECK(found(deliberately_faulty<BlindController>(), "visible 0: moves the swarm"));
  CHECK(found(deliberately_faulty<ShortController>(), "1 currents for 2 coils"));
}
