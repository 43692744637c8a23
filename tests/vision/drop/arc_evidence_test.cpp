#include "vision/drop/arc_evidence.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/vision/drop_pictures.h"
#include "vision/drop/arc_strip.h"

using namespace faba;

namespace {

DropScene short_arc() {
  DropScene s;
  s.radius = 700;
  s.centre = centre_for({330, 250}, s.radius, 160);
  s.step = 12;
  s.noise = 6;
  return s;
}

}  // namespace

TEST_CASE("edges of all shapes are significant") {
  for (const bool ring : {false, true})
    for (const double sign : {1.0, -1.0}) {
      DropScene s = short_arc();
      s.step = ring ? 0 : 12 * sign;
      s.ring = ring ? 12 * sign : 0;
      const ArcEvidence e = evaluate_arc(render(s), {s.centre, s.radius});
      CHECK(e.log10_false_alarms < -20);
      CHECK(e.support > 0.9);
      for (Vec2 p : e.points) CHECK(std::fabs(norm(p - s.centre) - s.radius) < 6);
    }
}

TEST_CASE(
    "edge points scatter about the true edge; the profile of a shifted circle shows the position of the "
    "edge") {
  const DropScene s = short_arc();
  const GrayF picture = render(s);
  const ArcEvidence on = evaluate_arc(picture, {s.centre, s.radius});
  REQUIRE(on.points.size() > 40);
  double mean = 0, square = 0;
  for (Vec2 p : on.points) mean += (norm(p - s.centre) - s.radius) / double(on.points.size());
  for (Vec2 p : on.points)
    square += std::pow(norm(p - s.centre) - s.radius - mean, 2) / double(on.points.size());
  CHECK(std::fabs(mean) < 5 * std::sqrt(square / double(on.points.size())));
  CHECK(square < 4);  // px^2; steps of 12 in noise of 6 averaged over 6 px: a few tenths of a px each

  const ArcEvidence beside = evaluate_arc(picture, {s.centre, s.radius + 4});
  CHECK(beside.log10_false_alarms < -20);
  const std::vector<double> profile = mean_profile(picture, {s.centre, s.radius + 4}, beside.angles, 16);
  REQUIRE(profile.size() == 33);
  // The half level, 4 px inside the circle, is sample 12. The mean over about 100 px of noise 6 has an error
  // of 0.6 of 12.
  CHECK(profile[12] - profile[30] == doctest::Approx(6).epsilon(0.4));
}

TEST_CASE("noise and cells give no significant circle") {
  int false_detections = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DropScene s;
    s.seed = seed;
    s.cells = seed % 2 ? 0 : 120;
    const GrayF picture = render(s);
    FrameNoise where(seed);
    for (int k = 0; k < 20; ++k) {
      const Circle circle{{640 * where.uniform(), 480 * where.uniform()}, 60 + 300 * where.uniform()};
      false_detections += evaluate_arc(picture, circle).log10_false_alarms < 0;
    }
  }
  // Below 0 means less than one such circle per picture among all its circles, about 1e8; none is expected
  // among 400.
  CHECK(false_detections == 0);
}

TEST_CASE("smoothly varying light is not an edge") {
  DropScene s;
  s.vignette = 0.5;
  s.noise = 2;
  const GrayF picture = render(s);
  const Vec2 middle{319.5, 239.5};
  // The contours of this light are circles about the centre; over 24 px of radius they are nearly a linear
  // gradient.
  for (const double radius : {100.0, 150.0, 200.0}) {
    GrayF flat = picture;
    for (int r = 0; r < s.height; ++r)
      for (int c = 0; c < s.width; ++c) {
        const Vec2 d = Vec2{double(c), double(r)} - middle;
        flat.at(c, r) += float(120 * 0.5 * dot(d, d) / dot(middle, middle));
      }
    CHECK(evaluate_arc(flat, {middle, radius}).log10_false_alarms > -3);
  }
}

TEST_CASE("a strip covers the visible part of a circle") {
  const GrayF picture(300, 200, 5.f);
  const ArcStrip full = read_arc_strip(picture, {{150, 100}, 60});
  CHECK(full.closed);
  CHECK(double(full.pieces.size()) * full.piece_px ==
        doctest::Approx(2 * std::numbers::pi * 60).epsilon(0.03));
  const ArcStrip part = read_arc_strip(picture, {{150, 100}, 120});  // crosses the top and bottom border
  CHECK_FALSE(part.closed);
  REQUIRE(!part.pieces.empty());
  CHECK(part.pieces.back().segment == 1);
  CHECK(read_arc_strip(picture, {{150, 100}, 1000}).pieces.empty());
  CHECK(read_arc_strip(picture, {{1e9, 100}, 5}).pieces.empty());
  CHECK(read_arc_strip(picture, {{-1e7, 100}, 1e7 + 150}).pieces.size() > 20);
}

TEST_CASE("a texture that starts at the edge is aligned by its start") {
  // Same mean on both sides; coarse blotches inside.
  DropScene s = short_arc();
  s.step = 0;
  s.noise = 1;
  s.cells = 6000;
  s.cell_grey = -15;
  ArcStrip strip = read_arc_strip(render(s), {s.centre, s.radius});
  align_by_change(strip);
  int near = 0;
  for (const ArcPiece& p : strip.pieces) near += std::fabs(p.shift) <= 4;
  // Random agreement: 8 of 24 px, a third. Half is 5 sd of a binomial of 80 above that.
  CHECK(near > int(strip.pieces.size()) / 2);
}
