// Field segments from the path of a swarm: a triangle wave along a tilted line with noise and known
// reversals.
#include "study/identify/found_segments.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "study/stats/study_random.h"

using namespace faba;

namespace {

constexpr double kFrame = 1.0 / 15, kTilt = 25 * std::numbers::pi / 180;

// Rests for 1 s, moves 90 px in 3 s, back in 3 s, and again 90 px in 3 s; 10 s in total.
double position_at(double t) {
  if (t < 1) return 0;
  const double u = std::fmod(t - 1, 6.0);
  return 30 * (u < 3 ? u : 6 - u);
}

struct Path {
  std::vector<double> t;
  std::vector<Vec2> at;
};
Path noisy_path(double noise_px) {
  Path w;
  StudyRandom random(1, StudyDraws{1});
  for (int k = 0; k <= 150; ++k) {
    const double t = k * kFrame, s = position_at(t);
    w.t.push_back(t);
    w.at.push_back({100 + s * std::cos(kTilt) + noise_px * random.normal(),
                    80 + s * std::sin(kTilt) + noise_px * random.normal()});
  }
  return w;
}

}  // namespace

TEST_CASE("field segments of a swarm: reversals within a frame, directions within a degree") {
  Path w = noisy_path(0.3);
  w.at[40] = {std::nan(""), std::nan("")};  // a frame without a visible swarm
  const auto segments = segments_of_swarm(w.t, w.at, 20);
  REQUIRE(segments.size() == 3);
  // Noise of 0.3 px at 30 px/s shifts the crossing of 5 % by 10 ms; the extrapolation increases this by half.
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(std::fabs(segments[k].t0_s - (1 + 3 * double(k))) < kFrame);
    const double want = k % 2 == 0 ? 25 : 205;
    CHECK(std::fabs(std::remainder(segments[k].direction_deg - want, 360)) < 1);
  }
  CHECK(segments[0].t1_s == segments[1].t0_s);
  CHECK(segments[2].t1_s == doctest::Approx(10));
}

TEST_CASE("field segments of a recorded field: exact to the frame") {
  std::vector<std::vector<double>> columns(3);
  for (int k = 0; k <= 90; ++k) {
    const double t = k * kFrame;
    // Commands at 0, 1, 3 and 3.2 s appear in the following rows; the y axis of the world points up.
    const double late = t - 0.5 * kFrame, b = late < 0     ? 0
                                              : late < 1   ? -60
                                              : late < 3   ? 60
                                              : late < 3.2 ? 0
                                                           : -60;
    columns[0].push_back(t);
    columns[1].push_back(b * std::cos(kTilt));
    columns[2].push_back(b * std::sin(kTilt));
  }
  const Series record("series.csv", {"t_s", "field_x_ut", "field_y_ut"}, columns);
  for (const bool against : {false, true}) {
    const auto segments = segments_of_field(record, against);
    REQUIRE(segments.size() == 2);
    CHECK(segments[0].t0_s == doctest::Approx(1));
    CHECK(segments[0].t1_s == doctest::Approx(3));
    CHECK(segments[1].t0_s == doctest::Approx(3.2));
    CHECK(segments[1].t1_s == doctest::Approx(6));
    CHECK(std::fabs(std::remainder(segments[0].direction_deg - (against ? 155 : 335), 360)) < 1e-9);
    CHECK(std::fabs(std::remainder(segments[1].direction_deg - (against ? 335 : 155), 360)) < 1e-9);
  }
  CHECK(segments_of_field(Series("series.csv", {"t_s"}, {{0, 1}}), false).empty());
}

TEST_CASE("field segments of a swarm: none without motion") {
  Path w = noisy_path(0.3);
  for (Vec2& at : w.at) at = {100 + 0.01 * at.x, 80 + 0.01 * at.y};
  CHECK(segments_of_swarm(w.t, w.at, 20).empty());
  CHECK(segments_of_swarm({}, {}, 20).empty());
}
