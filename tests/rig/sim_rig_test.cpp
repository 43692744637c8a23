#include "rig/sim_rig.h"

#include <doctest/doctest.h>

#include "tests/swarm.h"

using namespace faba;

TEST_CASE("frame 0 is the placed state; a delayed camera shows what was, time stamps and age say so") {
  for (const int delay : {0, 3}) {
    TestSwarm t("camera = { delay_frames = " + std::to_string(delay) +
                " }\n[[swarm]]\ncount = 20\nmodel = 'basic'\n");
    Rig& rig = t.simulation.loop().rig;
    std::vector<float> truth;
    for (int k = 0; k < 8; ++k) {
      Observation o;
      REQUIRE(rig.read(o));
      truth.push_back(t.column("x")[4]);
      CHECK(o.frame == std::uint64_t(k));
      CHECK(o.t == doctest::Approx((k - delay) / 15.0));
      CHECK(o.age == doctest::Approx(delay / 15.0));
      CHECK(o.seen[4].x == truth[std::size_t(std::max(0, k - delay))]);
    }
  }
}

TEST_CASE("the loop makes the rig safe on every way out, and limits what a controller asks") {
  TestSwarm t("limits = { max_current = '0.1 A' }\n[[swarm]]\ncount = 20\nmodel = 'basic'\n");
  struct Probe final : Sink {
    const World* world = nullptr;
    bool limited = false;
    void take(const Tick& tick) override {
      limited |= tick.limited;
      for (const double i : tick.command.current) CHECK(std::fabs(i) <= 0.1);
      if (tick.index == 5) throw Error(Errc::internal, "test", "stops here");
    }
  } probe;
  t.simulation.loop().sinks.push_back(&probe);
  t.world().command({1, 1});
  CHECK_THROWS_AS(run(t.simulation.loop(), 100, [] { return true; }), Error);
  CHECK(t.world().state().command == std::vector<double>{0, 0});
}

TEST_CASE("limits: clip, slew, not-a-number, stale pictures") {
  Limits::Params p;
  p.max_current = 1;
  p.max_slew = 2;
  Limits l(p);
  Command c{{0.5, -3}};
  CHECK(l.apply(c, 0.1, 0));
  CHECK(c.current == std::vector<double>{0.2, -0.2});
  c.current = {0.3, -0.3};
  CHECK_FALSE(l.apply(c, 0.1, 0));
  c.current = {std::nan(""), -0.3};
  CHECK(l.apply(c, 0.1, 0));
  CHECK(c.current[0] == doctest::Approx(0.1));  // towards zero, no faster than allowed
  c.current = {0.1, -0.3};
  CHECK(l.apply(c, 10, 5));
  CHECK(c.current == std::vector<double>{0, 0});
}
