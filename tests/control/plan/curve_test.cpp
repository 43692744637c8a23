// Curves and their shapes.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "control/plan/curve.h"

using namespace faba;

TEST_CASE("curve: positions by length, and the nearest point within a part") {
  const Curve c(std::vector<Vec2>{{0, 0}, {3, 0}, {3, 0}, {3, 4}});
  CHECK(c.length() == 7);
  CHECK(c.points().size() == 3);
  CHECK(c.at(-1) == Vec2{0, 0});
  CHECK(c.at(2) == Vec2{2, 0});
  CHECK(c.at(5) == Vec2{3, 2});
  CHECK(c.at(8) == Vec2{3, 4});
  CHECK(c.nearest({1, 2}, 0, 7) == 1);
  CHECK(c.nearest({1, 2}, 3, 7) == 5);  // on the second segment only
  CHECK(c.nearest({9, 9}, 0, 4) == 4);
  const Curve point(std::vector<Vec2>{{1, 1}});
  CHECK(point.length() == 0);
  CHECK(point.at(3) == Vec2{1, 1});
  CHECK(point.nearest({5, 5}, 0, 3) == 0);
}

TEST_CASE("curve: a spline passes through its points, in steps, and a straight line stays straight") {
  const std::vector<Vec2> points{{0, 0}, {10, 5}, {20, -3}, {21, 12}};
  for (const bool closed : {false, true}) {
    const std::vector<Vec2> spline = spline_through(points, closed, 0.5);
    const Curve c(spline);
    for (const Vec2 p : points) CHECK(norm(c.at(c.nearest(p, 0, c.length())) - p) < 1e-9);
    CHECK(spline.front() == points.front());
    CHECK(spline.back() == (closed ? points.front() : points.back()));
    // A smooth curve: its direction changes by little from step to step.
    for (std::size_t i = 2; i < spline.size(); ++i) {
      const Vec2 a = spline[i - 1] - spline[i - 2], b = spline[i] - spline[i - 1];
      CHECK(dot(a, b) > 0.7 * norm(a) * norm(b));
    }
  }
  for (const Vec2 p : spline_through(std::vector<Vec2>{{0, 0}, {1, 1}, {4, 4}}, false, 0.1))
    CHECK(p.x == doctest::Approx(p.y));
}

TEST_CASE("curve: circle, figure of eight and text have the size and centre that were asked for") {
  const Vec2 centre{100, 50};
  CHECK(Curve(circle(centre, 20, 0.1)).length() == doctest::Approx(20 * std::numbers::pi).epsilon(1e-4));
  // Arc length of x = a sin t, y = a/2 sin 2t: 6.0972 a, computed by quadrature.
  double length = 0;
  for (int i = 0; i < 100000; ++i) {
    const double t = 2 * std::numbers::pi * (i + 0.5) / 100000;
    length += std::hypot(std::cos(t), std::cos(2 * t)) * 2 * std::numbers::pi / 100000;
  }
  CHECK(Curve(figure_eight(centre, 20, 0.05)).length() == doctest::Approx(10 * length).epsilon(1e-4));
  for (const auto& points : {circle(centre, 20, 1), figure_eight(centre, 20, 1),
                             text_outline("W", centre, 20), text_outline("mtb 16-7", centre, 20)}) {
    double low = 1e9, high = -1e9;
    for (const Vec2 p : points) {
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
    CHECK(high - low == doctest::Approx(20).epsilon(0.01));
    CHECK((high + low) / 2 == doctest::Approx(100).epsilon(0.01));
  }
}

TEST_CASE("curve: each letter is a stroke of its own within its box") {
  std::vector<std::vector<Vec2>> all;
  for (const char c : kOutlineCharacters) {
    if (c == ' ') continue;
    const std::vector<Vec2> stroke = text_outline(std::string_view(&c, 1), {2, 3}, 4);
    REQUIRE(stroke.size() >= 2);
    for (const Vec2 p : stroke) {
      CHECK(p.x >= 0);
      CHECK(p.x <= 4);
      CHECK(p.y >= 0);
      CHECK(p.y <= 6);
    }
    for (const auto& other : all) CHECK_FALSE(stroke == other);
    all.push_back(stroke);
  }
}
