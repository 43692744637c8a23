// Same scenario, seed and version: same bits on any x86-64 machine, for any thread count and at any
// optimisation level. The hashes are literal. When a change of a model is meant to change them, say so in
// CHANGELOG.md and write the new ones. tests/CMakeLists.txt builds this file also with -O0 (SSE2 only) and
// with -mavx2 -mfma.
#include <doctest/doctest.h>

#include "tests/swarm.h"

using namespace faba;

namespace {

struct Golden {
  std::string scene;
  std::uint64_t frames;  // how many; all scenes are long enough
  std::string hash;
};
const Golden kGolden[] = {
    {"thesis-basic", 400, "34cd215c2548e957"},
    {"thesis-adapted", 400, "c8b4dd1612728815"},
    {"thesis-published", 400, "c00b37dd13c7146b"},
    {"corner", 90, "8c45bf6705b3ba2b"},
    {"steer", 300, "17f469a36d79f64c"},
    {"drop", 120, "ae58cdf511119754"},
    {"step-response", 60, "628eed194a9b912a"},
    {"aging", 60, "9e09d7661a1383b7"},
};

std::string hash_of(const Golden& g, unsigned threads) {
  const Scenario s =
      read_scenario(read_toml(std::string(FABA_SCENES) + "/" + g.scene + ".toml"), builtin_parts());
  Pool pool(threads);
  Simulation sim(s, 1, pool);
  run(sim.loop(), g.frames, [] { return true; });
  return sim.world().state().hash();
}

}  // namespace

TEST_CASE("literal state hashes, 1, 2, 3 and 7 threads") {
  for (const Golden& g : kGolden)
    for (const unsigned threads : {1u, 2u, 3u, 7u}) {
      INFO(g.scene, " with ", threads, " threads");
      CHECK(hash_of(g, threads) == g.hash);
    }
}

TEST_CASE("another seed gives another state") {
  const Scenario s = read_scenario(read_toml(std::string(FABA_SCENES) + "/corner.toml"), builtin_parts());
  Pool pool(1);
  Simulation a(s, 1, pool), b(s, 2, pool);
  CHECK(a.world().state().hash() != b.world().state().hash());
}
