#include "vision/drop/circle_fit.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/vision/drop_pictures.h"

using namespace faba;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// n equidistant points on an arc, with Gaussian scatter along both axes.
std::vector<Vec2> noisy_arc(Vec2 centre, double radius, double from_deg, double to_deg, int n, double sigma,
                            std::uint64_t seed) {
  FrameNoise noise(seed);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / (n - 1)) * kDegree;
    points.push_back({centre.x + radius * std::cos(a) + sigma * noise.gauss(),
                      centre.y + radius * std::sin(a) + sigma * noise.gauss()});
  }
  return points;
}

/// Kasa fit: linear least squares of x^2 + y^2 + Bx + Cy + D. Biased to small radii on short arcs.
double kasa_radius(const std::vector<Vec2>& points) {
  Vec2 mean;
  for (Vec2 p : points) mean = mean + (1.0 / double(points.size())) * p;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, z = 0;
  for (Vec2 p : points) {
    const Vec2 d = p - mean;
    const double w = 1.0 / double(points.size()), q = dot(d, d);
    xx += w * d.x * d.x;
    xy += w * d.x * d.y;
    yy += w * d.y * d.y;
    xz += w * d.x * q;
    yz += w * d.y * q;
    z += w * q;
  }
  const double det = xx * yy - xy * xy;
  const Vec2 c{(xz * yy - yz * xy) / det / 2, (yz * xx - xz * xy) / det / 2};
  return std::sqrt(dot(c, c) + z);
}

struct Trials {
  double bias = 0, scatter = 0, reported = 0, kasa_bias = 0;
};

/// 400 fits of a 25-degree arc of radius 1500, 100 points, scatter 1: T17.
Trials many_fits(CircleLoss loss) {
  constexpr int kTrials = 400;
  constexpr double kRadius = 1500;
  Trials t;
  double square = 0;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const auto points = noisy_arc({100, -50}, kRadius, 30, 55, 100, 1, std::uint64_t(seed));
    const auto start = fit_circle_pratt(points);
    REQUIRE(start);
    const CircleFit fit = refine_circle(points, *start, loss);
    t.bias += (fit.radius - kRadius) / kTrials;
    square += (fit.radius - kRadius) * (fit.radius - kRadius) / kTrials;
    t.reported += fit.sd_radius / kTrials;
    t.kasa_bias += (kasa_radius(points) - kRadius) / kTrials;
  }
  t.scatter = std::sqrt(square - t.bias * t.bias);
  return t;
}

}  // namespace

TEST_CASE("three points determine a circle in either order; collinear points do not") {
  const auto c = circle_through({13, 4}, {3, 14}, {-7, 4});
  REQUIRE(c);
  CHECK(c->centre.x == doctest::Approx(3));
  CHECK(c->centre.y == doctest::Approx(4));
  CHECK(c->radius == doctest::Approx(10));
  CHECK(circle_through({-7, 4}, {13, 4}, {3, 14})->radius == doctest::Approx(10));
  CHECK_FALSE(circle_through({0, 0}, {1, 2}, {3, 6}));
  CHECK_FALSE(circle_through({1, 1}, {1, 1}, {3, 6}));
}

TEST_CASE("exact points give the exact circle, from ten degrees to a full turn") {
  for (const double arc : {10.0, 25.0, 90.0, 350.0}) {
    const auto points = noisy_arc({-700, 1200}, 640, 70, 70 + arc, 40, 0, 1);
    const auto pratt = fit_circle_pratt(points);
    REQUIRE(pratt);
    // Rounding errors of 1e-16 are amplified by 1/half-angle^4 (2e4 for ten degrees) and by the ratio of the
    // distances.
    CHECK(pratt->radius == doctest::Approx(640).epsilon(1e-8));
    const CircleFit fit = refine_circle(points, *pratt, CircleLoss::tukey);
    CHECK(fit.radius == doctest::Approx(640).epsilon(1e-8));
    CHECK(fit.centre.x == doctest::Approx(-700).epsilon(1e-8));
    CHECK(fit.centre.y == doctest::Approx(1200).epsilon(1e-8));
    CHECK(fit.arc_rad == doctest::Approx(arc * kDegree).epsilon(1e-6));
    CHECK(fit.inliers.size() == 40);
    CHECK(fit.rms < 1e-6);
  }
}

TEST_CASE("T17: on a noisy arc of 25 degrees the bias is below the sd, and the sd equals the scatter") {
  const Trials square = many_fits(CircleLoss::square), tukey = many_fits(CircleLoss::tukey);
  // sd(R) = sigma sqrt(45/n)/alpha^2 is the leading term for small alpha and many points; the next terms are
  // alpha^2 = 5 % and 4/n = 4 %.
  const double alpha = 12.5 * kDegree, theory = std::sqrt(45.0 / 100) / (alpha * alpha);
  CHECK(square.reported == doctest::Approx(theory).epsilon(0.09));
  for (const Trials& t : {square, tukey}) {
    CHECK(std::fabs(t.bias) < t.scatter);
    // The mean of 400 has a standard error of scatter / 20; a limit of four gives one failure in 16000. The
    // true bias is of second order, scatter^2 / R = 0.13.
    CHECK(std::fabs(t.bias) < 4 * t.scatter / 20 + 0.13);
    // The relative error of a scatter from 400 values is 1/sqrt(800) = 3.5 %; limit four times that, and 5 %
    // more for Tukey weights, whose variance formula holds for many points only.
    CHECK(t.reported / t.scatter == doctest::Approx(1).epsilon(0.14 + 0.05));
  }
  // For comparison: the bias of the Kasa fit (theory A13: -18 px at alpha 0.2) is about one sd.
  CHECK(square.kasa_bias < -0.5 * square.scatter);
}

TEST_CASE("a third of outliers moves the robust fit by less than its standard deviations") {
  auto points = noisy_arc({2000, 900}, 1800, 170, 200, 120, 0.7, 5);
  FrameNoise noise(6);
  for (int i = 0; i < 60; ++i) points.push_back({640 * noise.uniform(), 480 * noise.uniform()});
  CircleSearchOptions options;
  const CircleFit fit = fit_circle(points, options);
  // Limit: five standard deviations; few outliers lie inside the tolerance (60 * 9 px along an arc of 640 px
  // in 480 px).
  CHECK(std::fabs(fit.radius - 1800) < 5 * fit.sd_radius);
  CHECK(std::fabs(fit.centre.x - 2000) < 5 * fit.sd_centre.x);
  CHECK(std::fabs(fit.centre.y - 900) < 5 * fit.sd_centre.y);
  CHECK(fit.sd_radius < 40);
  CHECK(fit.inliers.size() > 100);
  CHECK(fit.inliers.size() < 140);
  CHECK(std::is_sorted(fit.inliers.begin(), fit.inliers.end()));
}

TEST_CASE("RANSAC is reproducible, and different seeds agree within the uncertainty") {
  const auto points = noisy_arc({300, 200}, 150, 0, 330, 200, 0.5, 9);
  CircleSearchOptions options;
  const auto a = search_circles(points, {}, options), b = search_circles(points, {}, options);
  REQUIRE(a.size() == 1);
  CHECK(a[0].centre == b[0].centre);
  CHECK(a[0].radius == b[0].radius);
  options.seed = 99;
  const auto c = search_circles(points, {}, options);
  REQUIRE(c.size() == 1);
  CHECK(c[0].radius == doctest::Approx(a[0].radius).epsilon(0.01));
}

TEST_CASE("normals separate an edge from clutter") {
  // 80 points of an arc among 1200 points with random normals: 6 % of the points.
  std::vector<Vec2> points = noisy_arc({320, 1000}, 800, 255, 285, 80, 0.4, 3), normals;
  for (Vec2 p : points) normals.push_back((1 / norm(p - Vec2{320, 1000})) * (p - Vec2{320, 1000}));
  FrameNoise noise(4);
  for (int i = 0; i < 1200; ++i) {
    points.push_back({640 * noise.uniform(), 480 * noise.uniform()});
    const double a = 2 * std::numbers::pi * noise.uniform();
    normals.push_back({std::cos(a), std::sin(a)});
  }
  CircleSearchOptions options;
  options.max_scored = 2000;
  options.min_radius = 40;
  const auto found = search_circles(points, normals, options);
  REQUIRE(found.size() == 1);
  // sd(R) = 0.4 sqrt(45/80)/0.26^2 = 4.4; limit five sd.
  CHECK(std::fabs(found[0].radius - 800) < 22);
}

TEST_CASE("two circles are found in turn") {
  auto points = noisy_arc({200, 200}, 100, 0, 350, 150, 0.3, 1);
  const auto second = noisy_arc({500, 260}, 60, 0, 350, 100, 0.3, 2);
  points.insert(points.end(), second.begin(), second.end());
  CircleSearchOptions options;
  options.max_circles = 2;
  const auto found = search_circles(points, {}, options);
  REQUIRE(found.size() == 2);
  CHECK(found[0].radius == doctest::Approx(100).epsilon(0.01));
  CHECK(found[1].radius == doctest::Approx(60).epsilon(0.01));
}

TEST_CASE("points that are not on a circle are refused") {
  std::vector<Vec2> line;
  for (int i = 0; i < 50; ++i) line.push_back({3.0 * i, 4 + 1.7 * i});
  CHECK_FALSE(fit_circle_pratt(line));
  CHECK_FALSE(fit_circle_pratt(std::vector<Vec2>{{0, 0}, {1, 1}}));
  CHECK_FALSE(fit_circle_pratt(std::vector<Vec2>(10, Vec2{3, 4})));
  CHECK_THROWS_AS(fit_circle(line), Error);
  CHECK_THROWS_AS(refine_circle(line, {{0, 1e12}, 1e12}, CircleLoss::square), Error);
  CHECK_THROWS_AS(refine_circle(std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, 1}), Error);
  CHECK(search_circles({}, {}).empty());
}

TEST_CASE("the covered angle is the full turn minus the largest gap") {
  CHECK(covered_angle(noisy_arc({0, 0}, 5, 170, 200, 31, 0, 1), {0, 0}) == doctest::Approx(30 * kDegree));
  CHECK(covered_angle(noisy_arc({0, 0}, 5, 0, 270, 28, 0, 1), {0, 0}) == doctest::Approx(270 * kDegree));
  CHECK(covered_angle({}, {0, 0}) == 0);
}
