#include "sim/two_phase.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "core/random/philox.h"

using namespace faba;

namespace {

struct Crowd {
  std::vector<float> x, y, to_x, to_y;
  Sites taken;
};

// One cell each on random sites, with proposals up to `reach` away.
Crowd crowd(const Grid& g, std::size_t agents, float reach, std::uint64_t seed) {
  Crowd c;
  c.taken = Sites(std::size_t(g.columns) * std::size_t(g.rows));
  const auto at = [&](std::uint32_t i, std::uint32_t attempt) {
    const auto w = draw(seed, Stream::start, i, attempt);
    return std::pair{uniform(w[0]) * float(g.columns), uniform(w[1]) * float(g.rows)};
  };
  for (std::uint32_t i = 0; c.x.size() < agents; ++i) {
    const auto [x, y] = at(i, 0);
    if (c.taken.taken(g.index(x, y))) continue;
    c.taken.take(g.index(x, y));
    const auto w = draw(seed, Stream::motion, i, 0);
    c.x.push_back(x);
    c.y.push_back(y);
    c.to_x.push_back(x + reach * (2 * uniform(w[0]) - 1));
    c.to_y.push_back(y + reach * (2 * uniform(w[1]) - 1));
  }
  return c;
}

// Reference implementation of D4: all proposals see the same grid; the best proposal per site is granted.
void reference_resolve(const Grid& g, Crowd& c, std::uint64_t key, bool follow) {
  const std::size_t n = c.x.size();
  std::vector<bool> settled(n, false);
  for (int sweep = 0; sweep < (follow ? 8 : 1); ++sweep) {
    std::map<std::int32_t, std::uint32_t> best;
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto from = g.index(c.x[i], c.y[i]), to = g.index(c.to_x[i], c.to_y[i]);
      if (settled[i] || from == to || c.taken.taken(to)) continue;
      const auto [it, first] = best.try_emplace(to, i);
      if (!first && TwoPhase::priority(key, to, i) < TwoPhase::priority(key, to, it->second)) it->second = i;
    }
    for (const auto& [to, i] : best) c.taken.take(to);
    for (const auto& [to, i] : best) {
      c.taken.leave(g.index(c.x[i], c.y[i]));
      settled[i] = true;
    }
  }
  for (std::uint32_t i = 0; i < n; ++i)
    if (!settled[i] && g.index(c.x[i], c.y[i]) != g.index(c.to_x[i], c.to_y[i])) {
      c.to_x[i] = c.x[i];
      c.to_y[i] = c.y[i];
    }
}

}  // namespace

TEST_CASE("granted and refused moves follow the rule of D4, in one part and in several") {
  struct Case {
    Grid grid;
    std::size_t agents;
    float reach;
  };
  const std::vector<Case> cases{
      {{40, 30, 1, 0, 0}, 900, 1.5f},         // dense
      {{40, 30, 1, 0, 0}, 100, 50.0f},        // far moves, many of them to the border
      {{700, 500, 1, 0, 0}, 60000, 2.0f},     // several parts
      {{700, 500, 1, 0, 0}, 9000, 2.0f},      // unused blocks of sites
      {{2100, 1100, 1, 0, 0}, 30000, 40.0f},  // several regions, and moves between them
      {{1, 1, 1, 0, 0}, 1, 3.0f}};
  for (const Case& k : cases) {
    TwoPhase two_phase(k.grid);  // one for all: no call may depend on the calls before
    for (const bool follow : {false, true})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Crowd expected = crowd(k.grid, k.agents, k.reach, seed);
        const Crowd begin = expected;
        reference_resolve(k.grid, expected, seed, follow);
        for (const unsigned threads : {1u, 3u}) {
          INFO("grid ", k.grid.columns, " follow ", follow, " seed ", seed, " threads ", threads);
          Crowd c = begin;
          Pool pool(threads);
          two_phase.resolve(c.x, c.y, c.to_x, c.to_y, c.taken, seed, follow, pool);
          CHECK(c.to_x == expected.to_x);
          CHECK(c.to_y == expected.to_y);
          CHECK(c.taken == expected.taken);
        }
      }
  }
}
