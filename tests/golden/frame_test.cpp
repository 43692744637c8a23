// The same scenario and seed give bitwise equal rendered frames on x86-64 and arm64, for any number of
// threads and any optimisation level. The hashes are literal; a change that alters them on purpose must
// update them and be reported in CHANGELOG.md. tests/CMakeLists.txt builds this file also with -mavx2 -mfma,
// and `make dev` with -O0.
#include <doctest/doctest.h>

#include "app/scenario/read_scenario.h"
#include "core/hash.h"
#include "tests/swarm.h"
#include "vision/image/image.h"

using namespace faba;

namespace {

// Hashes of the images of two frames.
struct Pictures final : Sink {
  std::string hashes;
  void take(const Tick& t) override {
    if (t.index != 0 && t.index != 40) return;
    REQUIRE(t.seen.image);
    Hash h;
    h.bytes(t.seen.image->px.data(), t.seen.image->px.size());
    hashes += h.hex() + " ";
  }
};

std::string pictures(const Json& changes, unsigned threads) {
  Document d = read_toml(std::string(FABA_SCENES) + "/as-seen.toml");
  for (const auto& [path, value] : changes.items()) d.set(path, Json(value), "test");
  const Scenario s = read_scenario(d, builtin_parts());
  Pool pool(threads);
  Simulation sim(s, 1, pool);
  Pictures p;
  sim.loop().sinks.push_back(&p);
  run(sim.loop(), 41, [] { return true; });
  return p.hashes;
}

}  // namespace

TEST_CASE("literal hashes of rendered frames, 1, 2, 3 and 7 threads") {
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    CHECK(pictures(Json::object(), threads) == "78664edb1dc8bcba ab27c78f1ca153d1 ");
    CHECK(pictures({{"microscope.cell_length", "4 um"},
                    {"microscope.depth_spread", "8 um"},
                    {"microscope.flicker", 0.01},
                    {"microscope.contrast", 0.4},
                    {"microscope.level", 0.3}},
                   threads) == "9cfd90cd57bf052c a49b2afbaac6abac ");
  }
}
