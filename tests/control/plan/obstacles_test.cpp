#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "control/plan/obstacles.h"

using namespace faba;

namespace {

const Polygon kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

double length(Vec2 from, const std::vector<Vec2>& path) {
  double sum = 0;
  for (const Vec2 p : path) {
    sum += norm(p - from);
    from = p;
  }
  return sum;
}

}  // namespace

TEST_CASE("obstacles: nearest edge, outside, inside and in both directions of the corners") {
  for (const bool reversed : {false, true}) {
    Polygon p = kSquare;
    if (reversed) std::reverse(p.begin(), p.end());
    const NearestEdge outside = nearest_edge(p, {3, 0.5});
    CHECK(outside.distance == doctest::Approx(2));
    CHECK(outside.outward.x == doctest::Approx(1));
    const NearestEdge inside = nearest_edge(p, {0.75, 0});
    CHECK(inside.distance == doctest::Approx(-0.25));
    CHECK(inside.outward.x == doctest::Approx(1));
    const NearestEdge on = nearest_edge(p, {1, 0});
    CHECK(on.distance == doctest::Approx(0));
    CHECK(on.outward.x == doctest::Approx(1));
  }
}

TEST_CASE("obstacles: the shortest path keeps its distance and is the shortest") {
  CHECK(shortest_path(std::vector<Polygon>{kSquare}, {-3, 2}, {3, 2}, 0.1).size() == 1);
  const Vec2 from{-3, 0}, to{3, 0};
  const std::vector<Vec2> path = shortest_path(std::vector<Polygon>{kSquare}, from, to, 0.1);
  REQUIRE(path.size() == 3);
  Vec2 before = from;
  for (const Vec2 p : path) {
    CHECK_FALSE(crosses(kSquare, before, p));
    before = p;
  }
  // Over two corners that are moved outwards by 0.1 along both axes.
  CHECK(length(from, path) == doctest::Approx(2 * std::sqrt(1.9 * 1.9 + 1.1 * 1.1) + 2.2));
  // With walls all around, no path leads out.
  const std::vector<Polygon> walls{{{-2, -2}, {2, -2}, {2, -1.5}, {-2, -1.5}},
                                   {{-2, 1.5}, {2, 1.5}, {2, 2}, {-2, 2}},
                                   {{-2, -2}, {-1.5, -2}, {-1.5, 2}, {-2, 2}},
                                   {{1.5, -2}, {2, -2}, {2, 2}, {1.5, 2}}};
  CHECK(shortest_path(walls, {0, 0}, {5, 0}, 0.1).size() == 1);
}
