#include "study/steering/polyline.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random/philox.h"

using namespace faba;

namespace {

Vec2 random_point(std::uint32_t i, std::uint32_t of) {
  const auto w = draw(1, Stream::study, i, of);
  return {200 * double(normals(w[0], w[1])[0]), 100 * double(normals(w[2], w[3])[0])};
}

double distance_to_any(Vec2 p, const std::vector<Vec2>& vertex) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < vertex.size(); ++i) {
    const Vec2 ab = vertex[i + 1] - vertex[i];
    const double along = std::clamp(dot(p - vertex[i], ab) / dot(ab, ab), 0.0, 1.0);
    best = std::min(best, norm(p - vertex[i] - along * ab));
  }
  return best;
}

}  // namespace

TEST_CASE("distance to a corner") {
  const Polyline corner({{0, 0}, {10, 0}, {10, 10}});
  CHECK(corner.distance({5, 3}) == doctest::Approx(3));
  CHECK(corner.distance({-3, -4}) == doctest::Approx(5));
  CHECK(corner.distance({12, 4}) == doctest::Approx(2));
  CHECK(corner.distance({10, 0}) == 0);
}

TEST_CASE("distance is the smallest of the distances to all segments") {
  for (const std::uint32_t count : {2U, 3U, 40U, 2000U}) {
    std::vector<Vec2> vertex;
    for (std::uint32_t i = 0; i < count; ++i) vertex.push_back(random_point(i, 0));
    const Polyline line(vertex);
    for (std::uint32_t i = 0; i < 300; ++i) {
      const Vec2 p = random_point(i, 1);
      CHECK(std::fabs(line.distance(p) - distance_to_any(p, vertex)) < 1e-10);
    }
  }
}
