// A program that links only faba_engine runs scenarios with the same results as the program faba.
#include <doctest/doctest.h>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"
#include "tests/golden/hashes.h"

using namespace faba;

TEST_CASE("the engine gives the golden state hashes") {
  const Parts parts = engine_parts();
  for (const Golden& g : kGolden) {
    INFO(g.scene);
    const Scenario s = read_scenario(read_toml(std::string(FABA_SCENES) + "/" + g.scene + ".toml"), parts);
    Pool pool(2);
    Simulation sim(s, 1, pool);
    run(sim.loop(), g.frames, [] { return true; });
    CHECK(sim.world().state().hash() == g.hash);
  }
}

TEST_CASE("a scenario with a bench or optical flow can be read; the engine ignores these sections") {
  const Scenario s = read_scenario(read_toml(std::string(FABA_SCENES) + "/bench.toml"), engine_parts());
  CHECK_FALSE(s.rig.has_value());
  CHECK(s.resolved().contains("controller"));
  CHECK_FALSE(s.resolved().contains("rig"));
}

TEST_CASE("the engine refuses files that it cannot read with a clear message") {
  const auto refusal = [](const std::string& toml) -> std::string {
    try {
      const Scenario s = read_scenario(parse_toml(toml + "[[swarm]]\ncount = 3\n", "test"), engine_parts());
      Pool pool(1);
      const Simulation simulation(s, 1, pool);
    } catch (const Error& e) {
      CHECK(e.code() == Errc::usage);
      return e.what();
    }
    return "accepted";
  };
  CHECK(refusal("[library]\nfile = 'l.h5'\n").find("cannot read HDF5") != std::string::npos);
  CHECK(refusal("[microscope]\nbackground = 'v.avi'\n[camera]\nsensor = 'frames'\n")
            .find("cannot read videos") != std::string::npos);
}
