#include "vision/drop/drop_edge.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/vision/drop_pictures.h"
#include "vision/drop/drop_side.h"

using namespace faba;

namespace {

/// Detects the edge and compares it with the true circle, in units of the reported sd and in px.
DropEdge check_found(const DropScene& s) {
  CAPTURE(s.radius);
  CAPTURE(s.seed);
  const DropEdge d = find_drop_edge(render(s));
  // Four standard deviations: one failure in 16000 if the sd are correct.
  CHECK(std::fabs(d.radius_px - s.radius) < 4 * d.sd_radius_px);
  // Along the visible arc the circle is more accurate than its centre: the position error of a piece of 6 px
  // is about blur times noise / contrast, at worst 2 px here, and about 50 pieces determine three parameters.
  CHECK(arc_distance(s, d.centre_image, d.radius_px) < 4 * 2 * std::sqrt(3.0 / 50) * 2);
  CHECK(d.image_width == s.width);
  CHECK(d.image_height == s.height);
  CHECK(d.support > 0.8);
  CHECK(norm(d.inside_image - s.centre) < s.radius);
  CHECK(d.inside_image.x >= 0);
  CHECK(d.inside_image.y >= 0);
  CHECK(d.inside_image.x <= s.width - 1);
  CHECK(d.inside_image.y <= s.height - 1);
  CHECK(d.centre_side_inside);
  return d;
}

std::string refusal(const GrayF& picture, DropEdgeOptions options = {}) {
  options.name = "frame.tif";
  try {
    const DropEdge d = find_drop_edge(picture, options);
    return fmt::format("found a circle of radius {}", d.radius_px);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::input);
    CHECK(e.where() == "frame.tif");
    CHECK(std::string(e.what()).find("; ") != std::string::npos);  // reason; advice
    return e.what();
  }
}

bool check_contains(const std::string& text, const char* part) {
  INFO(text);
  const bool found = text.find(part) != std::string::npos;
  CHECK(found);
  return found;
}

void add_line(GrayF& im, Vec2 through, double angle_deg, double step) {
  const double a = angle_deg * std::numbers::pi / 180;
  for (int r = 0; r < im.height; ++r)
    for (int c = 0; c < im.width; ++c)
      if ((c - through.x) * std::cos(a) + (r - through.y) * std::sin(a) > 0) im.at(c, r) += float(step);
}

}  // namespace

TEST_CASE("short arcs of all edge shapes are detected") {
  std::uint64_t seed = 0;
  for (const double radius : {480.0, 900.0, 2000.0})
    for (const int bits : {8, 16})
      for (const double sign : {1.0, -1.0})
        for (const bool ring : {false, true}) {
          DropScene s;
          s.seed = ++seed;
          s.radius = radius;
          s.centre = centre_for({320 + 60 * std::cos(double(seed)), 240}, radius, 47 * double(seed));
          (ring ? s.ring : s.step) = 30 * sign;
          s.noise = 5;
          s.bits = bits;
          s.gain = bits == 16 ? 20 : 1;
          s.hot_pixels = bits == 16 ? 40 : 0;
          s.cells = 40;
          s.vignette = 0.2;
          const DropEdge d = check_found(s);
          CHECK(d.contrast * sign > 0);  // bright inside or bright line: positive
        }
}

TEST_CASE("complete drops, wide arcs and dim 16-bit pictures are detected") {
  DropScene s;
  s.width = 518;
  s.height = 488;
  s.centre = {258.3, 228.8};
  s.radius = 161;
  s.ground = 70;
  s.step = 60;
  s.noise = 15;
  s.bits = 16;
  const DropEdge full = check_found(s);
  CHECK(full.arc_deg > 350);
  CHECK(full.sd_radius_px < 1);
  s.centre = {60, 200};
  s.radius = 240;
  s.seed = 2;
  const DropEdge wide = check_found(s);
  // Visible from -asin(200/240) = -56 to acos(-60/240) = 104 degrees; up to 6 px at either end are excluded.
  CHECK(wide.arc_deg > 161 - 2 * 12);
  CHECK(wide.arc_deg < 161);
}

TEST_CASE("an elliptical drop: the uncertainty of the radius contains both half axes") {
  DropScene s;
  s.radius = 150;
  s.step = 40;
  const GrayF round = render(s);
  const DropEdge circle = find_drop_edge(round);
  CHECK(circle.out_of_round_px < 0.5);
  GrayF stretched(round.width, round.height);  // by 5 % along x
  for (int r = 0; r < round.height; ++r)
    for (int c = 0; c < round.width; ++c) {
      const double x = s.centre.x + (c - s.centre.x) / 1.05;
      const int left = int(x);
      const float f = float(x - left);
      stretched.at(c, r) = (1 - f) * round.at(left, r) + f * round.at(left + 1, r);
    }
  const DropEdge d = find_drop_edge(stretched);
  CHECK(d.out_of_round_px == doctest::Approx(0.025 * s.radius).epsilon(0.25));
  CHECK(d.radius_px - 2 * d.sd_radius_px < s.radius);
  CHECK(d.radius_px + 2 * d.sd_radius_px > 1.05 * s.radius);
}

TEST_CASE("a second circular edge is reported") {
  DropScene s;
  s.radius = 120;
  s.step = 30;
  GrayF im = render(s);
  CHECK(!find_drop_edge(im).other);
  for (int r = 0; r < im.height; ++r)
    for (int c = 0; c < im.width; ++c) {
      const double t = std::hypot(c - s.centre.x - 5, r - s.centre.y) - 160;
      im.at(c, r) -= float(40 * std::exp(-t * t / 8));
    }
  const DropEdge d = find_drop_edge(im);
  REQUIRE(d.other);
  const double smaller = std::min(d.radius_px, d.other->radius),
               larger = std::max(d.radius_px, d.other->radius);
  CHECK(smaller == doctest::Approx(120).epsilon(0.02));
  CHECK(larger == doctest::Approx(160).epsilon(0.02));
}

TEST_CASE("an edge below the pixel noise is detected in coarser pyramid levels") {
  DropScene s;
  s.radius = 600;
  s.centre = centre_for({300, 230}, s.radius, 200);
  s.step = 8;
  s.blur = 3;
  s.noise = 10;
  check_found(s);
}

TEST_CASE("many cells inside do not prevent detection") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    DropScene s;
    s.seed = seed;
    s.radius = 260;
    s.centre = {200, 330};
    s.step = 40;
    s.cells = 350;
    s.noise = 4;
    check_found(s);
  }
}

TEST_CASE("the result is reproducible bit for bit") {
  DropScene s;
  s.radius = 500;
  s.centre = centre_for({320, 240}, s.radius, 75);
  s.ring = -25;
  s.cells = 60;
  const GrayF picture = render(s);
  const DropEdge a = find_drop_edge(picture), b = find_drop_edge(picture);
  CHECK(a.centre_image == b.centre_image);
  CHECK(a.radius_px == b.radius_px);
  CHECK(a.edge_points == b.edge_points);
}

TEST_CASE("stretching and hot pixels: the result does not depend on the grey scale of the picture") {
  DropScene s;
  s.radius = 180;
  s.centre = {330, 210};
  s.step = 25;
  const GrayF picture = render(s);
  GrayF scaled = picture;
  for (float& p : scaled.px) p = 1000 + 16 * p;
  CHECK(find_drop_edge(scaled).radius_px == doctest::Approx(find_drop_edge(picture).radius_px).epsilon(1e-4));
  CHECK(find_drop_edge(scaled).contrast ==
        doctest::Approx(16 * find_drop_edge(picture).contrast).epsilon(1e-2));
}

TEST_CASE("pictures without an edge are refused") {
  check_contains(refusal(GrayF(640, 480, 88.f)), "uniform");
  check_contains(refusal(GrayF(40, 300, 88.f)), "40 x 300");
  GrayF hole(320, 240, 5.f);
  hole.at(3, 4) = std::numeric_limits<float>::quiet_NaN();
  check_contains(refusal(hole), "finite");
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    DropScene s;
    s.seed = seed;
    s.noise = double(seed);
    s.vignette = 0.1 * double(seed - 1);
    check_contains(refusal(render(s)), "no drop edge detected");
    s.cells = 50 * int(seed);
    s.bits = 16;
    s.gain = 30;
    s.hot_pixels = 60;
    check_contains(refusal(render(s)), "no drop edge detected");
  }
}

TEST_CASE("quantisation contours of smooth light are not an edge") {
  DropScene s;
  s.noise = 0;
  s.vignette = 0.3;
  check_contains(refusal(render(s)), "no drop edge detected");
}

TEST_CASE("a straight edge is reported as straight") {
  for (const double angle : {0.0, 20.0, 71.0, 90.0}) {
    DropScene s;
    s.seed = std::uint64_t(angle) + 1;
    s.cells = 30;
    GrayF picture = render(s);
    add_line(picture, {300, 250}, angle, 30);
    check_contains(refusal(picture), "straight");
  }
}

TEST_CASE("an arc below ten degrees is refused; the error has its angle") {
  DropScene s;
  s.radius = 5500;  // 480 px are 5 degrees
  s.centre = centre_for({320, 240}, s.radius, 5);
  s.step = 40;
  const std::string why = refusal(render(s));
  check_contains(why, "covers only");
  check_contains(why, "10 degrees required");
  DropEdgeOptions lenient;
  lenient.min_arc_deg = 3;
  const DropEdge d = find_drop_edge(render(s), lenient);
  CHECK(std::fabs(d.radius_px - s.radius) < 4 * d.sd_radius_px);
}

TEST_CASE("a corner and a ruler are not a drop") {
  GrayF corner = render(DropScene{});
  for (int r = 0; r < corner.height; ++r)
    for (int c = 0; c < corner.width; ++c)
      if (c > 200 && r > 150) corner.at(c, r) += 50;
  const std::string why = refusal(corner);
  CHECK(why.find("found") == std::string::npos);
  GrayF ruler = render(DropScene{});
  for (int r = 100; r < 300; ++r)
    for (int c = 0; c < ruler.width; ++c)
      if (c % 16 < 4 && r < (c % 80 < 16 ? 300 : 220)) ruler.at(c, r) -= 80;
  CHECK(refusal(ruler).find("found") == std::string::npos);
}

TEST_CASE("the drop is on the side of the centre, unless cells or the user option indicate otherwise") {
  DropScene s;
  s.radius = 300;
  s.centre = {120, 420};
  s.step = 30;
  s.cells = 120;
  s.cells_outside = true;
  const GrayF bubble = render(s);
  const DropEdge away = find_drop_edge(bubble);
  CHECK_FALSE(away.centre_side_inside);
  CHECK(norm(away.inside_image - s.centre) > s.radius);
  CHECK(away.contrast < 0);
  DropEdgeOptions side_options;
  side_options.side = DropSide::centre;
  const DropEdge centre = find_drop_edge(bubble, side_options);
  CHECK(centre.centre_side_inside);
  CHECK(norm(centre.inside_image - s.centre) < s.radius);
  side_options.side = DropSide::away;
  s.cells_outside = false;
  CHECK(find_drop_edge(render(s)).centre_side_inside);
  CHECK_FALSE(find_drop_edge(render(s), side_options).centre_side_inside);
}

TEST_CASE("point_on_side gives a point in the picture and on the given side") {
  for (const Circle& c : {Circle{{320, 240}, 100}, Circle{{-900, 200}, 1000}, Circle{{320, -2000}, 2100}}) {
    for (const bool inside : {true, false}) {
      const Vec2 p = point_on_side(640, 480, c, inside);
      CHECK((norm(p - c.centre) < c.radius) == inside);
      CHECK((p.x >= 0 && p.y >= 0 && p.x <= 639 && p.y <= 479));
    }
  }
}
