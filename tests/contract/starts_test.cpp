// Starts, called directly: without World, which draws again for positions outside the arena.
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/contract/contract.h"
#include "tests/swarm.h"

#include "core/random/draw_blocks.h"

using namespace faba;
using contract::Findings;

namespace {

/// A start that proposes some positions outside the arena, as permitted (sim/start.h): the caller draws
/// again.
struct Partly {
  std::string at;  ///< "start in arena"
  double inside;   ///< minimum fraction of positions inside the arena
};
/// A round drop has pi/4 of the area of the square of `uniform`. A box ends at the centres of its border
/// pixels (A2), but the two starts draw from complete pixels.
const std::vector<Partly> kPartly{
    {"uniform in drop", 0.75}, {"uniform in box", 0.99}, {"visible in box", 0.99}};

using StartPart = StartRegistry::PartType;

/// Draws like those of World, and draws at the range ends of the uniform numbers.
std::vector<PlaceDraw> place_draws() {
  constexpr double kLeast = 0.5 * 0x1p-32;
  std::vector<PlaceDraw> all;
  for (int corner = 0; corner < 8; ++corner) {
    PlaceDraw d;
    for (int j = 0; j < 3; ++j) d.u[std::size_t(j)] = (corner >> j) % 2 ? 1 - kLeast : kLeast;
    all.push_back(d);
  }
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const auto w = draw(1, Stream::start, i, 0);
    PlaceDraw d;
    for (std::size_t j = 0; j < 3; ++j) d.u[j] = (double(w[j]) + 0.5) * 0x1p-32;
    d.cell = i % 1000;
    d.attempt = i / 1000;
    all.push_back(d);
  }
  return all;
}

/// Contract violations of a start: positions must be finite, inside the arena (at least the fraction
/// `inside`), and in view with Trait::in_view.
Findings faults_of_start(const StartPart& part, const Arena& arena, double inside = 1) {
  const auto start = part.make({&arena});
  const Frame frame = arena.frame();
  int positions = 0, not_finite = 0, outside = 0, out_of_view = 0;
  for (const PlaceDraw& d : place_draws()) {
    const auto at = start->place(d);
    if (!at) continue;
    ++positions;
    if (!std::isfinite(norm(*at)))
      ++not_finite;
    else if (arena.depth(*at) < 0)
      ++outside;
    if (!frame.in_view(frame.image_from_world(*at))) ++out_of_view;
  }
  Findings found;
  if (positions == 0) found.push_back("no position");
  if (not_finite > 0)
    found.push_back(fmt::format("{} of {} positions are not finite", not_finite, positions));
  if (outside > (1 - inside) * positions)
    found.push_back(fmt::format("{} of {} positions are outside the arena", outside, positions));
  if (part.has(Trait::in_view) && out_of_view > 0)
    found.push_back(fmt::format("{} of {} positions are out of view", out_of_view, positions));
  return found;
}

/// Deliberately faulty: outside of every arena.
struct OutsideStart final : Start {
  struct Params {};
  static constexpr std::array kTraits = {Trait::in_view};
  static Schema<Params> schema() { return {"outside", "Outside of the edge"}; }
  OutsideStart(const Params&, const StartContext& c) : grid(c.arena->grid()) {}
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    return Vec2{double(grid.left) - double(grid.cell) * (1 + d.u[0]), 0};
  }
  Grid grid;
};
/// Deliberately faulty: NaN for some of the draws.
struct NowhereStart final : Start {
  struct Params {};
  static Schema<Params> schema() { return {"nowhere", "NaN"}; }
  NowhereStart(const Params&, const StartContext&) {}
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    return Vec2{1e-6 * std::sqrt(d.u[0] - 0.01), 0};
  }
};

template <class T>
StartPart faulty_start() {
  StartRegistry registry("start", "Deliberately faulty");
  registry.add<T>();
  return contract::resolved(registry, registry.names().front());
}

}  // namespace

TEST_CASE("every start in every arena: positions are finite, in the arena, and in view with Trait::in_view") {
  const Scale scale;
  std::set<std::string> used;
  for (const auto& arena_name : contract::parts().arena.names()) {
    const auto arena = contract::resolved(contract::parts().arena, arena_name).make({scale});
    for (const auto& name : contract::parts().start.names()) {
      const std::string here = name + " in " + arena_name;
      INFO(here);
      const StartPart part = contract::resolved(contract::parts().start, name);
      const auto partly =
          std::find_if(kPartly.begin(), kPartly.end(), [&](const Partly& p) { return p.at == here; });
      if (partly == kPartly.end()) {
        CHECK_NO_FINDINGS(faults_of_start(part, *arena));
        continue;
      }
      if (!faults_of_start(part, *arena).empty()) used.insert(here);
      CHECK_NO_FINDINGS(faults_of_start(part, *arena, partly->inside));
    }
  }
  for (const Partly& p : kPartly) {
    INFO(p.at, " is never outside, or does not exist: remove it from the table");
    CHECK(used.count(p.at) == 1);
  }
}

TEST_CASE("deliberately faulty starts are detected") {
  const auto box = contract::resolved(contract::parts().arena, "box").make({Scale{}});
  CHECK(faults_of_start(faulty_start<OutsideStart>(), *box) ==
        Findings{"4008 of 4008 positions are outside the arena", "4008 of 4008 positions are out of view"});
  const Findings nowhere = faults_of_start(faulty_start<NowhereStart>(), *box);
  REQUIRE(nowhere.size() == 1);
  CHECK(nowhere[0].find("are not finite") != std::string::npos);
}

TEST_CASE("every start in every arena: World places a swarm inside") {
  for (const auto& name : contract::parts().start.names())
    for (const auto& arena : contract::parts().arena.names()) {
      INFO(name, " in ", arena);
      TestSwarm t("arena = '" + arena + "'\n[[swarm]]\ncount = 400\nstart = '" + name + "'\n");
      const auto x = t.column("x"), y = t.column("y");
      for (std::size_t k = 0; k < x.size(); ++k)
        CHECK(t.world().parts().arena->depth({double(x[k]), double(y[k])}) >= 0);
    }
}
