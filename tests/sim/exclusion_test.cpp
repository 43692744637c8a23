#include <doctest/doctest.h>

#include <set>

#include "tests/swarm.h"

using namespace faba;

namespace {

// A dense box: 2000 cells on 60 x 50 pixels, all driven into one corner.
std::string crowd(const std::string& exclusion) {
  return "arena = { type = 'box', size_px = [60, 50] }\nexclusion = { " + exclusion +
         " }\n[[swarm]]\ncount = 2000\nstart = 'uniform'\nmodel = { type = 'basic', max_speed = 3 }\n";
}

std::size_t distinct_sites(TestSwarm& t) {
  const Grid g = t.world().parts().arena->grid();
  const auto x = t.column("x"), y = t.column("y");
  std::set<std::int32_t> cells;
  for (std::size_t i = 0; i < x.size(); ++i) cells.insert(g.index(x[i], y[i]));
  return cells.size();
}

}  // namespace

TEST_CASE("T15: each site has at most one cell, and the number of cells is constant") {
  for (const char* exclusion :
       {"order = 'two-phase'", "order = 'two-phase', follow = true", "order = 'published'",
        "order = 'published', collision = 'last-free'", "order = 'published', collision = 'axis-split'",
        "order = 'two-phase', integer_positions = true", "order = 'published', integer_positions = true"}) {
    TestSwarm t(crowd(exclusion));
    t.world().command({0.5, 0.5});
    for (int i = 0; i < 60; ++i) {
      t.world().step();
      INFO(exclusion, " step ", i);
      REQUIRE(distinct_sites(t) == 2000);
    }
  }
}

TEST_CASE("T14, T15: bitwise equal results for any number of threads") {
  for (const char* exclusion : {"order = 'two-phase'", "order = 'two-phase', follow = true"}) {
    std::string first;
    for (const unsigned threads : {1u, 2u, 3u, 7u}) {
      TestSwarm t(crowd(exclusion), 5, threads);
      t.world().command({0.5, -0.2});
      for (int i = 0; i < 50; ++i) t.world().step();
      const std::string hash = t.world().state().hash();
      if (first.empty()) first = hash;
      CHECK(hash == first);
    }
  }
}

TEST_CASE("two-phase: a site occupied at the start of a step is closed; with follow it opens when left") {
  // Two neighbouring cells move right by one pixel per step: without follow the second waits, with it both
  // move.
  for (const bool follow : {false, true}) {
    TestSwarm t(std::string("arena = { type = 'box', size_px = [20, 5] }\nexclusion = { follow = ") +
                (follow ? "true" : "false") +
                " }\n[[swarm]]\ncount = 2\npolarity = 'north'\nmodel = { type = 'basic', max_speed = 0 }\n");
    const double px = 0.9164e-6;
    t.alter([&](State& s) {
      s.agents["x"][0] = float(-3.5 * px);
      s.agents["x"][1] = float(-2.5 * px);
      s.agents["y"][0] = s.agents["y"][1] = 0;
    });
    t.world().command({23e-6 / 0.5932e-3, 0});
    t.world().step();
    const auto x = t.column("x");
    CHECK(double(x[1]) == doctest::Approx(-1.5 * px));
    CHECK(double(x[0]) == doctest::Approx((follow ? -2.5 : -3.5) * px));
  }
}

TEST_CASE("two-phase: exactly one of several cells moves to a site, and each wins with equal probability") {
  // Agents left and right of an empty site both propose it. Over many seeds each wins in half of the trials.
  int left_wins = 0;
  const int trials = 400;
  for (int seed = 1; seed <= trials; ++seed) {
    TestSwarm t(
        "arena = { type = 'box', size_px = [21, 5] }\n"
        "[[swarm]]\ncount = 1\npolarity = 'north'\nmodel = { type = 'basic', max_speed = 0 }\n"
        "[[swarm]]\ncount = 1\npolarity = 'south'\nmodel = { type = 'basic', max_speed = 0 }\n",
        std::uint64_t(seed));
    const double px = 0.9164e-6;
    t.alter([&](State& s) {
      s.agents["x"][0] = float(-px);
      s.agents["x"][1] = float(px);
      s.agents["y"][0] = s.agents["y"][1] = 0;
    });
    t.world().command({23e-6 / 0.5932e-3, 0});
    t.world().step();
    const auto x = t.column("x");
    const bool left = std::fabs(double(x[0])) < 0.01 * px, right = std::fabs(double(x[1])) < 0.01 * px;
    REQUIRE(left != right);
    left_wins += left;
  }
  CHECK(std::abs(left_wins - trials / 2) < 4 * std::sqrt(trials) / 2);  // binomial, four standard deviations
}

TEST_CASE("published: a site left in this iteration is free for later agents") {
  TestSwarm t(
      "arena = { type = 'box', size_px = [20, 5] }\nexclusion = { order = 'published' }\n"
      "[[swarm]]\ncount = 2\npolarity = 'north'\nmodel = { type = 'basic', max_speed = 0 }\n");
  const double px = 0.9164e-6;
  const auto after = [&](double x0, double x1) {
    t.alter([&](State& s) {
      s.agents["x"][0] = float(x0 * px);
      s.agents["x"][1] = float(x1 * px);
      s.agents["y"][0] = s.agents["y"][1] = 0;
    });
    t.world().command({23e-6 / 0.5932e-3, 0});
    t.world().step();
    return std::pair{double(t.column("x")[0]) / px, double(t.column("x")[1]) / px};
  };
  CHECK(after(-2.5, -3.5).second == doctest::Approx(-2.5));  // agent 0 ahead: moves first, agent 1 follows
  CHECK(after(-3.5, -2.5).first == doctest::Approx(-3.5));   // agent 0 behind: still blocked at its turn
}

TEST_CASE("a swarm that does not fit is refused before the start") {
  CHECK_THROWS_WITH_AS(
      TestSwarm("arena = { type = 'box', size_px = [40, 25] }\n[[swarm]]\ncount = 1000000\n"),
      "swarm: 1000000 cells do not fit into the arena, which has at most 1000 pixels, with one cell per "
      "pixel; "
      "use fewer cells, a larger arena, or exclusion.order = \"none\"",
      Error);
  CHECK_THROWS_WITH_AS(TestSwarm("[[swarm]]\ncount = 1000\nstart = { type = 'disc', radius_px = 3 }\n"),
                       doctest::Contains("the region is too small for one cell per pixel"), Error);
}
