// Contract of every registered part.
#include <limits>

#include "tests/contract/contract.h"
#include "tests/swarm.h"

#include "app/scenario/read_scenario.h"

using namespace faba;

namespace {

const Parts& kParts = contract::parts();

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

TEST_CASE("every part: defaults are valid, every parameter is documented, output can be read back") {
  each_kind(kParts, [&](const char* kind, const auto& registry) {
    for (const auto& name : registry.names()) {
      INFO(std::string(kind), " ", name);
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

TEST_CASE("every model: bitwise equal for any number of threads, finite in zero and in strong fields") {
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

TEST_CASE("a position that is not finite is reported with its cell, step and swarm") {
  TestSwarm t(model_scene("'dipole'"));
  t.world().step();
  t.alter([](State& s) { s.agents["y"][7] = std::numeric_limits<float>::quiet_NaN(); });
  try {
    t.world().check_finite();
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.where() == "cell 7");
    CHECK(e.reason().find("position is not finite after step 1; the parameters of swarm[0].model") == 0);
  }
}

TEST_CASE("R4, every model: the motion of an agent depends on its index, not on the other agents") {
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

TEST_CASE("every arena: cells stay inside for any proposed move") {
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
