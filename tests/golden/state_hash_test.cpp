// The same scenario, seed and version give bitwise equal states on x86-64 and arm64, for any number of
// threads and any optimisation level. The hashes are literal; a change of a model that alters them on purpose
// must update them and be reported in CHANGELOG.md. tests/CMakeLists.txt builds this file also with
// -mavx2 -mfma, and `make dev` with -O0.
#include <doctest/doctest.h>

#include "app/scenario/read_scenario.h"
#include "tests/golden/hashes.h"
#include "tests/swarm.h"

using namespace faba;

namespace {

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

TEST_CASE("different seeds give different states") {
  const Scenario s = read_scenario(read_toml(std::string(FABA_SCENES) + "/corner.toml"), builtin_parts());
  Pool pool(1);
  Simulation a(s, 1, pool), b(s, 2, pool);
  CHECK(a.world().state().hash() != b.world().state().hash());
}
