#include "study/tracks/populations.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/random/draw_blocks.h"
#include "core/random/philox.h"

using namespace faba;

namespace {

constexpr double kFrame = 0.1, kError = 0.1;  // s; px, of a position
Pool pool(2);

std::array<float, 2> normal_pair(std::uint32_t a, std::uint32_t b) {
  const auto w = draw(5, Stream::study, a, b);
  return normals(w[0], w[1]);
}

// A track that starts at frame `begin`, with a velocity in px/s that may change from frame to frame.
template <class Velocity>
Track track_of(std::uint32_t number, std::uint64_t begin, int points, const Velocity& velocity) {
  Track t;
  t.number = number;
  Vec2 at{100, 100};
  for (int i = 0; i < points; ++i) {
    const auto e = normal_pair(number, std::uint32_t(i));
    const std::uint64_t frame = begin + std::uint64_t(i);
    t.points.push_back(
        {frame, double(frame) * kFrame, at.x + kError * double(e[0]), at.y + kError * double(e[1]), 1, 10});
    at = at + kFrame * velocity(i);
  }
  return t;
}

Vec2 in_direction(std::uint32_t number, double speed) {
  const double angle = 2.4 * number;
  return {speed * std::cos(angle), speed * std::sin(angle)};
}

}  // namespace

TEST_CASE("objects that move and objects that do not move are separated, with their fractions and speeds") {
  PopulationSurvey survey(kFrame);
  for (std::uint32_t k = 1; k <= 60; ++k) {
    const double speed = k % 3 == 0 ? 0 : 40 * std::exp(0.2 * double(normal_pair(1000, k)[0]));
    survey.take(track_of(k, 0, 50, [&](int) { return in_direction(k, speed); }));
  }
  const auto found = survey.populations(1, kError, pool);
  REQUIRE(found.size() == 2);
  CHECK(found[0].motion == PopulationMotion::still);
  CHECK(found[0].fraction == doctest::Approx(1.0 / 3).epsilon(1e-9));
  CHECK(found[0].tracks == 20);
  CHECK(found[1].motion == PopulationMotion::moving);
  CHECK(found[1].ci90[0] < 40);
  CHECK(found[1].ci90[1] > 40);
  CHECK(found[1].speed_px_s == doctest::Approx(40).epsilon(0.1));  // 40 tracks with a spread of 20 %
}

TEST_CASE("one population is not divided") {
  PopulationSurvey survey(kFrame);
  for (std::uint32_t k = 1; k <= 100; ++k)
    survey.take(track_of(k, 0, 40, [&](int) {
      return in_direction(k, 30 * std::exp(0.4 * double(normal_pair(2000, k)[0])));
    }));
  const auto found = survey.populations(1, kError, pool);
  REQUIRE(found.size() == 1);
  CHECK(found[0].fraction == 1);
  CHECK(found[0].motion == PopulationMotion::moving);
}

TEST_CASE("objects that stop and start belong to both populations for the time that they spend in each") {
  PopulationSurvey survey(kFrame);
  for (std::uint32_t k = 1; k <= 30; ++k)
    survey.take(track_of(k, 0, 401, [&](int i) { return in_direction(k, i / 100 % 2 == 0 ? 50 : 0); }));
  const auto found = survey.populations(1, kError, pool);
  REQUIRE(found.size() == 2);
  CHECK(found[0].motion == PopulationMotion::still);
  CHECK(found[0].fraction ==
        doctest::Approx(0.5).epsilon(0.05));  // windows of four frames, 3 of 100 contain a change
  CHECK(found[1].speed_px_s == doctest::Approx(50).epsilon(0.02));
}

TEST_CASE("slow objects that all move in one direction are drifting") {
  PopulationSurvey survey(kFrame);
  for (std::uint32_t k = 1; k <= 60; ++k)
    survey.take(track_of(k, 0, 50, [&](int) {
      return Vec2{6, 1} + (k % 2 == 0 ? in_direction(k, 60) : Vec2{});
    }));
  const auto found = survey.populations(2, kError, pool);
  REQUIRE(found.size() == 2);
  CHECK(found[0].motion == PopulationMotion::drifting);
  CHECK(found[1].motion == PopulationMotion::moving);
}

TEST_CASE("too few windows give no population") {
  PopulationSurvey survey(kFrame);
  survey.take(track_of(1, 0, 3, [](int) { return Vec2{10, 0}; }));
  CHECK(survey.populations(1, kError, pool).empty());
}
