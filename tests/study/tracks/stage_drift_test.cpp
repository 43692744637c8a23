#include "study/tracks/stage_drift.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

constexpr double kFrame = 0.1, kError = 0.1;  // s; px, of a position
constexpr int kFrames = 60;

// Tracks of objects with a velocity each (px/s) and a random walk, in a picture that moves.
struct Scene {
  cells::Dice dice{3};
  Vec2 drift;         // px/s
  double jitter = 0;  // px
  DriftSurvey survey{kFrame};
  std::uint64_t number = 0;
  std::vector<Vec2> stage;

  Scene(Vec2 velocity, double shaking) : drift(velocity), jitter(shaking) {
    for (int i = 0; i < kFrames; ++i)
      stage.push_back(kFrame * i * drift + jitter * Vec2{dice.normal(), dice.normal()});
  }
  void add(Vec2 velocity, double walk_px = 0) {
    Track t;
    t.number = ++number;
    Vec2 at{200 * dice.uniform(), 200 * dice.uniform()};
    for (int i = 0; i < kFrames; ++i) {
      const Vec2 p = at + stage[std::size_t(i)] + kError * Vec2{dice.normal(), dice.normal()};
      t.points.push_back({std::uint64_t(i), i * kFrame, p.x, p.y, 1, 10});
      at = at + kFrame * velocity + walk_px * Vec2{dice.normal(), dice.normal()};
    }
    survey.take(t);
  }
  // `n` cells that swim with a speed of 20 +- 3 px/s within `spread` rad of the direction x.
  void swim(int n, double spread) {
    for (int k = 0; k < n; ++k) {
      const double angle = spread * (2 * dice.uniform() - 1), speed = 20 + 3 * dice.normal();
      add({speed * std::cos(angle), speed * std::sin(angle)});
    }
  }
  void fixed(int n) {
    for (int k = 0; k < n; ++k) add({});
  }
};

}  // namespace

TEST_CASE("stage: objects that keep their distances among swimming cells show drift and jitter") {
  Scene s({8, -3}, 0.3);
  s.fixed(10);
  s.swim(20, 3.14);
  const StageDrift d = s.survey.result();
  CHECK(d.finding == StageFinding::drifting);
  CHECK(d.references == 10);
  CHECK(std::fabs(d.drift_px_s.x - 8) < 5 * d.drift_se_px_s);
  CHECK(std::fabs(d.drift_px_s.y + 3) < 5 * d.drift_se_px_s);
  CHECK(d.drift_se_px_s < 0.1);
  CHECK(d.jitter_px == doctest::Approx(0.3).epsilon(0.25));  // 59 steps
  // Relative to the stage a fixed object has its localisation error only, and that of the path.
  const Track relative = d.relative(s.survey.tracks().front());
  const TrackPoint &first = relative.points.front(), &last = relative.points.back();
  CHECK(std::hypot(last.x_px - first.x_px, last.y_px - first.y_px) < 1);
}

TEST_CASE("stage: a swarm that swims in one direction past objects at rest is not a drift") {
  Scene s({}, 0);
  s.fixed(6);
  s.swim(40, 0.1);
  CHECK(s.survey.result().finding == StageFinding::at_rest);
}

TEST_CASE("stage: it is not decided by a swarm alone, nor by diffusing particles in a flow") {
  Scene swarm({}, 0);
  swarm.swim(40, 0.1);
  CHECK(swarm.survey.result().finding == StageFinding::undecided);
  Scene beads({5, 2}, 0);
  for (int k = 0; k < 100; ++k) beads.add({}, 0.8);
  CHECK(beads.survey.result().finding == StageFinding::undecided);
}

TEST_CASE("stage: all objects that move in formation are reported as such") {
  Scene s({4, 0}, 0);
  s.fixed(30);
  const StageDrift d = s.survey.result();
  CHECK(d.finding == StageFinding::all_rigid);
  CHECK(norm(d.drift_px_s) == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("stage: objects at rest do not drift") {
  Scene s({}, 0);
  s.fixed(30);
  const StageDrift d = s.survey.result();
  CHECK(d.finding == StageFinding::at_rest);
  CHECK(d.jitter_px < 0.1);
}

TEST_CASE("stage: no tracks, and short tracks, decide nothing") {
  CHECK(DriftSurvey(kFrame).result().finding == StageFinding::undecided);
}
