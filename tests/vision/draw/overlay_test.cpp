#include "vision/draw/overlay.h"

#include <doctest/doctest.h>

#include "tests/vision/drop_pictures.h"
#include "vision/files/picture.h"

using namespace faba;

TEST_CASE("the overlay keeps the grey picture and draws the edge in colour") {
  DropScene s;
  s.radius = 170;
  s.centre = {300, 220};
  s.step = 60;
  const GrayF picture = render(s);
  const DropEdge edge = find_drop_edge(picture);
  const RgbImage overlay = drop_overlay(displayed(picture), edge);
  CHECK(overlay.width == 640);
  CHECK(overlay.height == 480);
  auto is_grey = [&](int c, int r) {
    const Rgb p = overlay.at(c, r);
    return p.r == p.g && p.g == p.b;
  };
  CHECK(is_grey(10, 10));
  CHECK(is_grey(630, 470));
  CHECK_FALSE(is_grey(300 + 170, 220));
  CHECK_FALSE(is_grey(300 - 170, 220));
  CHECK_FALSE(is_grey(300, 220 + 170));
  CHECK_FALSE(is_grey(300, 220));  // the cross at the centre
  // Blue and not red nor violet along the circle: sky blue has more blue than red.
  int blue = 0, coloured = 0;
  for (int k = 0; k < 360; ++k) {
    const double a = k * std::numbers::pi / 180;
    const Rgb p =
        overlay.at(int(std::lround(300 + 170 * std::cos(a))), int(std::lround(220 + 170 * std::sin(a))));
    coloured += !(p.r == p.g && p.g == p.b);
    blue += p.b > p.r;
  }
  CHECK(coloured > 340);
  CHECK(blue > 180);
}

TEST_CASE("a circle much larger than the picture and an empty picture can be drawn") {
  DropEdge edge;
  edge.radius_px = 1e6;
  edge.centre_image = {320, 1e6 + 240};
  edge.image_width = 64;
  edge.image_height = 48;
  CHECK(drop_overlay(displayed(GrayF(64, 48, 3.f)), edge).width == 64);
  CHECK(drop_overlay({}, DropEdge{}).empty());
}
