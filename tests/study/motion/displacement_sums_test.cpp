// Sums of pictures over the objects of others against the displacement, of single spots.
#include "study/motion/displacement_sums.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/units.h"

using namespace faba;

namespace {

constexpr double kSize = 3;  // px, full width at half maximum

/// A Gaussian spot on an empty picture.
GrayF spot(double x, double y) {
  GrayF g(96, 80);
  const double sd = kSize / 2.3548;
  for (int r = 0; r < g.height; ++r)
    for (int c = 0; c < g.width; ++c)
      g.px[std::size_t(r * g.width + c)] =
          float(60 * std::exp(-(std::pow(c - x, 2) + std::pow(r - y, 2)) / (2 * sd * sd)));
  return g;
}

/// The part of a profile near a displacement.
struct Spot {
  double sum = 0, shift = 0;
};

Spot spot_of(const ShiftProfile& p, int near) {
  Spot s;
  for (int d = near - 4; d <= near + 4; ++d) {
    s.sum += p[profile_index(d)];
    s.shift += d * p[profile_index(d)];
  }
  s.shift /= s.sum;
  return s;
}

Vec2 unit(double degrees) { return {std::cos(degrees * kDegree), std::sin(degrees * kDegree)}; }

}  // namespace

TEST_CASE("displacement sums: a spot that moves is at its displacement, in any direction") {
  const ObjectPicture before = object_picture(spot(40, 40), kSize, 1);
  for (const double degrees : {0, 30, 135, 250}) {
    CAPTURE(degrees);
    const Vec2 d = unit(degrees);
    const ShiftWindow window{d, 1.4 * kSize};
    const ObjectPicture after = object_picture(spot(40 + 8 * d.x, 40 + 8 * d.y), kSize, 1);
    const Spot moved = spot_of(PictureCorrelator(window).between(before, after).profile(window), 8);
    CHECK(moved.shift == doctest::Approx(8).epsilon(0.03));
    const Spot still = spot_of(PictureCorrelator(window).between(before, before).profile(window), 0);
    CHECK(std::fabs(still.shift) < 0.01);
    // The mask has about 25 pixels, of which one or two more or less depend on the position in the grid.
    CHECK(moved.sum == doctest::Approx(still.sum).epsilon(0.08));
  }
}

TEST_CASE("displacement sums: the displacement across the direction is that of the spot") {
  const ObjectPicture before = object_picture(spot(40, 40), kSize, 1);
  for (const double off : {-15, -5, 0, 10}) {
    CAPTURE(off);
    const Vec2 d = unit(off);
    const ObjectPicture after = object_picture(spot(40 + 10 * d.x, 40 + 10 * d.y), kSize, 1);
    const ShiftWindow wide{{1, 0}, 3 * kSize};
    const double across = PictureCorrelator(wide).between(before, after).across(wide, 5, 15);
    CHECK(across == doctest::Approx(10 * std::sin(off * kDegree)).epsilon(0.05).scale(10));
  }
}

TEST_CASE("displacement sums: nothing prevails where nothing moves") {
  const ObjectPicture still = object_picture(spot(40, 40), kSize, 1);
  const ShiftWindow wide{{1, 0}, 3 * kSize};
  CHECK(PictureCorrelator(wide).between(still, still).across(wide, 2, 10) == 0);
}
