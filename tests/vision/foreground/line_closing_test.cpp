#include "vision/foreground/kernels/line_closing.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/vec.h"

using namespace faba;

namespace {

constexpr double kRadius = 60, kLine = 1, kSpot = 2;  // px: of the ring, half of its width, of a spot
constexpr float kLight = 150, kDark = 90;
const Vec2 kCentre{79.5, 79.5}, kSpotAt{kCentre.x + kRadius - 6, kCentre.y};

double from_ring(double x, double y) { return std::fabs(norm(Vec2{x, y} - kCentre) - kRadius); }
double from_spot(double x, double y) { return norm(Vec2{x, y} - kSpotAt); }

/// A dark ring, and a dark spot beside it.
GrayF ring_and_spot() {
  GrayF g(160, 160, kLight);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (from_ring(x, y) < kLine || from_spot(x, y) < kSpot) g.px[std::size_t(y * g.width + x)] = kDark;
  return g;
}

/// Grey levels by which a closing raises the picture, at most, where `distance` is below `reach`.
template <class Distance>
float raised(const LineClosing& closing, Distance distance, double reach) {
  const GrayF before = ring_and_spot();
  float most = 0;
  for (int y = 0; y < before.height; ++y)
    for (int x = 0; x < before.width; ++x) {
      const std::size_t i = std::size_t(y * before.width + x);
      if (distance(x, y) < reach) most = std::max(most, closing.least.px[i] - before.px[i]);
    }
  return most;
}

}  // namespace

// A straight segment of 31 px leaves the ring by 31^2 / (8 * 60) = 2 px, the width of its line.
TEST_CASE("line closing: segments bent as a ring leave the ring and fill a spot beside it") {
  Pool pool(1);
  const LineClosing straight = line_closing(ring_and_spot(), 31, pool),
                    bent = line_closing(ring_and_spot(), 31, pool, kRadius);
  CHECK(raised(straight, from_ring, kLine) == kLight - kDark);
  CHECK(raised(bent, from_ring, 0.5 * kLine) == 0);
  CHECK(raised(straight, from_spot, kSpot) == kLight - kDark);
  CHECK(raised(bent, from_spot, kSpot) == kLight - kDark);
}

TEST_CASE("line closing: a radius without effect on the pixels of a segment gives straight ones") {
  const GrayF g = ring_and_spot();
  Pool pool(1);
  CHECK(line_closing(g, 31, pool, 1000).least.px == line_closing(g, 31, pool).least.px);
}

TEST_CASE("line closing: the result does not depend on the number of threads") {
  const GrayF g = ring_and_spot();
  Pool one(1), three(3);
  const LineClosing a = line_closing(g, 31, one, kRadius), b = line_closing(g, 31, three, kRadius);
  CHECK(a.least.px == b.least.px);
  CHECK(a.largest.px == b.largest.px);
}
