// Pure pursuit: the setpoint of reference `path`.
#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/parts.h"
#include "control/controller.h"
#include "control/plan/curve.h"
#include "core/archive.h"
#include "core/error.h"
#include "core/toml.h"

using namespace faba;

namespace {

const Parts kParts = builtin_parts();
constexpr double kPx = 1e-6;

std::unique_ptr<Reference> path(const std::string& keys) {
  const Document d = parse_toml("[p]\ntype = 'path'\n" + keys, "test");
  ControlContext c;
  c.scale = {kPx, 1.0 / 60, 23e-6};
  c.frame = {kPx, 640, 480, {319.5, 239.5}};
  return kParts.reference.resolve(Node(d).child("p")).make(c);
}
Vec2 world(Vec2 image) { return Frame{kPx, 640, 480, {319.5, 239.5}}.world_from_image(image); }
Estimate at(Vec2 image) {
  Estimate e;
  e.centroid = world(image);
  e.visible = 10;
  return e;
}

}  // namespace

TEST_CASE("path: the setpoint is the look-ahead distance ahead of the nearest point, and never goes back") {
  const auto r = path("points_px = [[100, 100], [300, 100]]\nlook_ahead_px = 20");
  const auto check = [&](Vec2 swarm, Vec2 expected, bool finished = false) {
    const Target t = r->update(at(swarm));
    CHECK(norm(t.position - world(expected)) < 1e-3 * kPx);
    CHECK(t.finished == finished);
  };
  check({50, 150}, {100, 100});  // the start, until the swarm comes near
  CHECK(r->path_done() == 0);
  check({95, 110}, {120, 100});
  check({110, 105}, {130, 100});
  check({104, 100}, {130, 100});  // further back: the setpoint stays
  CHECK(*r->path_done() == doctest::Approx(0.05));
  check({290, 100}, {190, 100});  // only three look-ahead distances are searched
  check({290, 100}, {250, 100});
  check({290, 100}, {300, 100}, true);
  CHECK(r->path_done() == 1);
}

TEST_CASE("path: a curve that crosses itself is followed in its order") {
  const auto r = path("shape = 'figure_eight'\nsize_px = 200\nlook_ahead_px = 10\nlaps = 2");
  Vec2 swarm{319.5, 239.5};
  const Frame frame{kPx, 640, 480, {319.5, 239.5}};
  const Curve eight(figure_eight({319.5, 239.5}, 200, 0.5));
  double travelled = 0;
  double farthest = 0;
  Target t;
  for (int k = 0; k < 5000 && !t.finished; ++k) {
    t = r->update(at(swarm));
    const Vec2 to = frame.image_from_world(t.position) - swarm;
    const double step = std::min(1.0, norm(to));
    travelled += step;
    if (norm(to) > 0) swarm = swarm + (step / norm(to)) * to;
    farthest = std::max(farthest, norm(swarm - eight.at(eight.nearest(swarm, 0, eight.length()))));
  }
  CHECK(t.finished);
  // A pursuit cuts a bend of radius R by at most L^2 / (2 R), here with R >= 25 px at the tops of the eight.
  CHECK(farthest < 10.0 * 10 / (2 * 25) + 1);
  CHECK(travelled == doctest::Approx(2 * eight.length()).epsilon(0.05));
}

TEST_CASE("path: without cells the setpoint stays; a checkpoint restores it; wrong keys are refused") {
  const std::string keys = "points_px = [[100, 100], [200, 200], [300, 100]]\nclosed = true\nlaps = 2";
  const auto a = path(keys);
  for (double x = 100; x < 160; x += 2) a->update(at({x, x}));
  const Vec2 before = a->update(at({160, 160})).position;
  Estimate lost = at({200, 200});
  lost.visible = 0;
  CHECK(a->update(lost).position == before);

  Archive out;
  a->archive(out);
  const auto b = path(keys);
  Archive in(out.bytes());
  b->archive(in);
  CHECK(b->update(at({170, 170})).position == a->update(at({170, 170})).position);

  CHECK_THROWS_AS(path("points_px = [[100, 100]]"), Error);
  CHECK_THROWS_AS(path("points_px = [[100, 100], [100, 100]]"), Error);
  CHECK_THROWS_AS(path("shape = 'text'\ntext = ''"), Error);
  CHECK_THROWS_AS(path("shape = 'text'\ntext = 'a?'"), Error);
}

TEST_CASE(
    "path: with the longest look-ahead distance no part of a closed curve is left out; a longer one is "
    "refused") {
  for (const char* shape : {"figure_eight", "circle"}) {
    CAPTURE(shape);
    const std::string keys = std::string("shape = '") + shape + "'\nsize_px = 200\nlook_ahead_px = ";
    const std::vector<Vec2> points = std::string_view(shape) == "circle"
                                         ? circle({319.5, 239.5}, 200, 1)
                                         : figure_eight({319.5, 239.5}, 200, 1);
    const Curve curve(points);
    const double most = std::floor(curve.length() / 4);
    CHECK_THROWS_AS(path(keys + std::to_string(most + 2)), Error);
    const auto r = path(keys + std::to_string(most - 1));
    // A swarm on the curve: the progress is the length that it has covered, until half a look-ahead distance
    // is left.
    for (double s = 0; s < curve.length() - most / 2 - 2; s += 1) {
      const Target t = r->update(at(curve.at(s)));
      REQUIRE_FALSE(t.finished);
      REQUIRE(*r->path_done() == doctest::Approx(s / curve.length()).epsilon(0.01).scale(1));
    }
    for (double s = curve.length() - most / 2; s < curve.length(); s += 1) r->update(at(curve.at(s)));
    CHECK(r->path_done() == 1);
  }
  // A short curve has a shorter default.
  CHECK_NOTHROW(path("shape = 'circle'\nsize_px = 10"));
}
