// What every registered part must keep, whoever wrote it.
#include <doctest/doctest.h>

#include <limits>

#include "tests/swarm.h"

#include "app/scenario/read_scenario.h"

using namespace faba;

namespace {

const Parts kParts = builtin_parts();

std::string model_scene(const std::string& model, const std::string& more = "") {
  return "exclusion = { order = 'none' }\narena = { type = 'box', size_px = [300, 200] }\n" + more +
         "[[swarm]]\ncount = 5000\nmodel = " + model + "\n";
}

std::string stepped(const std::string& toml, unsigned threads, int steps = 40) {
  TestSwarm t(toml, 3, threads);
  t.world().command({0.4, -0.3});
  for (int i = 0; i < steps; ++i) t.world().step();
  t.world().check_finite();
  return t.world().state().hash();
}

}  // namespace

TEST_CASE("every part: defaults are valid, every parameter is documented, what it writes it reads back") {
  each_kind(kParts, [&](const char* kind, const auto& registry) {
    for (const auto& name : registry.names()) {
      INFO(kind, " ", name);
      const Json& schema = registry.json_schema(name);
      CHECK(schema["description"].template get<std::string>().size() > 10);
      for (const auto& [key, field] : schema["properties"].items()) {
        INFO(key);
        CHECK((field.contains("description") || field.contains("properties")));
        if (field.contains("x-unit") && field.contains("minimum")) CHECK(field.contains("type"));
      }
      if (name == "route" || name == "rig" || name == "map" || name == "playback")
        continue;  // these have no default
      Document d;
      d.root = Json{{"part", name}};
      const auto part = registry.resolve(Node(d).child("part"));
      Document again = parse_toml(to_toml(Json{{"part", part.resolved}}), "again");
      CHECK(registry.resolve(Node(again).child("part")).resolved == part.resolved);
      d.root["part"] = part.resolved;
      d.root["part"]["surely_not_a_key"] = 1;
      CHECK_THROWS_AS(registry.resolve(Node(d).child("part")), Error);
    }
  });
}

TEST_CASE("every number of every part: its range ends are accepted, beyond is refused") {
  each_kind(kParts, [&](const char* kind, const auto& registry) {
    for (const auto& name : registry.names())
      for (const auto& [key, field] : registry.json_schema(name)["properties"].items()) {
        if (!field.contains("minimum") && !field.contains("maximum")) continue;
        INFO(kind, " ", name, " ", key);
        for (const char* end : {"minimum", "maximum"}) {
          if (!field.contains(end)) continue;
          const double at = field[end].template get<double>();
          const double beyond = std::string(end) == "minimum" ? at - std::max(1.0, std::fabs(at))
                                                              : at + std::max(1.0, std::fabs(at));
          Document d;
          d.root = Json{{"part", Json{{"type", name}, {key, beyond}}}};
          CHECK_THROWS_AS(registry.resolve(Node(d).child("part")), Error);
        }
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
          Document d;
          d.root = Json{{"part", Json{{"type", name}, {key, bad}}}};
          CHECK_THROWS_AS(registry.resolve(Node(d).child("part")), Error);
        }
      }
  });
}

TEST_CASE("every model: same bits for any thread count, finite in no field and in a strong one") {
  for (const auto& name : kParts.model.names()) {
    INFO(name);
    const std::string scene = model_scene("'" + name + "'");
    const std::string one = stepped(scene, 1);
    for (const unsigned threads : {2u, 3u, 7u}) CHECK(stepped(scene, threads) == one);
    for (const double current : {0.0, 1e3}) {
      TestSwarm t(scene);
      t.world().command({current, current});
      for (int i = 0; i < 20; ++i) t.world().step();
      CHECK_NOTHROW(t.world().check_finite());
    }
  }
}

TEST_CASE("R4, every model: what an agent does depends on its number, not on who else is there") {
  for (const auto& name : kParts.model.names()) {
    INFO(name);
    TestSwarm many(model_scene("'" + name + "'"));
    Document d = parse_toml(model_scene("'" + name + "'"), "few");
    d.set("swarm[0].count", std::string("77"), "test");
    Pool pool(1);
    Simulation few(read_scenario(d, kParts), 1, pool);
    for (World* w : {&many.world(), &few.world()}) {
      w->command({0.2, 0.1});
      for (int i = 0; i < 30; ++i) w->step();
    }
    const auto a = many.column("x"), b = few.world().state().agents["x"];
    CHECK(std::equal(b.begin(), b.end(), a.begin()));
  }
}

TEST_CASE("every arena: whoever is pushed out stays in, whatever the push") {
  for (const auto& name : kParts.arena.names()) {
    INFO(name);
    TestSwarm t("exclusion = { order = 'none' }\narena = '" + name +
                "'\n[[swarm]]\ncount = 3000\nmodel = { type = 'basic', "
                "max_speed = 700 }\n");
    for (int i = 0; i < 60; ++i) {
      t.world().command({3.0 * (i % 7 - 3), 2.0 * (i % 5 - 2)});
      t.world().step();
      const auto x = t.column("x"), y = t.column("y");
      for (std::size_t k = 0; k < x.size(); ++k)
        REQUIRE(t.world().parts().arena->depth({double(x[k]), double(y[k])}) >= 0);
    }
  }
}

TEST_CASE("every controller: finite and quiet on hostile estimates") {
  const Scenario s = read_scenario(parse_toml("[[swarm]]\ncount = 1\n", "t"), kParts);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const auto& name : kParts.controller.names()) {
    INFO(name);
    Document d;
    d.root = Json{{"c", name}};
    const ControlContext context{s.field.make({}), s.si_scale(), Frame{}, -1, 1.0 / 15, 0, {2, 2}};
    const auto controller = kParts.controller.resolve(Node(d).child("c")).make(context);
    Limits limits(s.limits);
    for (const double bad : {0.0, nan, inf, -inf, 1e300, 1e-300})
      for (const double visible : {0.0, 1.0, nan}) {
        Estimate e;
        e.centroid = {bad, -bad};
        e.visible = visible;
        Command c = controller->update(e, {{bad, 0}, 0, false}, 1.0 / 15);
        limits.apply(c, 1.0 / 15, 0);
        for (const double i : c.current) CHECK(std::fabs(i) <= s.limits.max_current);
      }
  }
}

TEST_CASE("every start: inside the arena") {
  for (const auto& name : kParts.start.names())
    for (const auto& arena : kParts.arena.names()) {
      INFO(name, " in ", arena);
      TestSwarm t("arena = '" + arena + "'\n[[swarm]]\ncount = 400\nstart = '" + name + "'\n");
      const auto x = t.column("x"), y = t.column("y");
      for (std::size_t k = 0; k < x.size(); ++k)
        CHECK(t.world().parts().arena->depth({double(x[k]), double(y[k])}) >= 0);
    }
}
