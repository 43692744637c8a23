#include "study/tracks/track_statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

constexpr double kFrame = 0.05;

// Statistics of tracks of walkers with speed v, rotational diffusion dr, translational diffusion d, drift,
// and localisation error s.
TrackSummary walk(int tracks, int frames, double v, double dr, double d, Vec2 drift, double s,
                  std::uint64_t seed, int interval = 0) {
  cells::Dice dice(seed);
  TrackStatistics statistics(kFrame, interval);
  constexpr int kSteps = 10;
  const double h = kFrame / kSteps;
  for (int i = 0; i < tracks; ++i) {
    Track t;
    t.number = std::uint64_t(i + 1);
    Vec2 p{100 * dice.uniform(), 100 * dice.uniform()};
    double angle = 6.283185307 * dice.uniform();
    for (int k = 0; k < frames; ++k) {
      t.points.push_back(
          {std::uint64_t(k), k * kFrame, p.x + s * dice.normal(), p.y + s * dice.normal(), 1, 1});
      for (int j = 0; j < kSteps; ++j) {
        angle += std::sqrt(2 * dr * h) * dice.normal();
        p = p + h * (v * Vec2{std::cos(angle), std::sin(angle)} + drift) +
            std::sqrt(2 * d * h) * Vec2{dice.normal(), dice.normal()};
      }
    }
    statistics.take(t);
  }
  return statistics.summary();
}

bool within(const Estimated& e, double truth, double errors = 4) {
  return std::fabs(e.value - truth) < errors * e.se;
}

}  // namespace

TEST_CASE("diffusion: D, localisation error and drift are recovered within their errors") {
  for (const double s : {0.0, 0.5, 2.0}) {
    CAPTURE(s);
    const TrackSummary r = walk(300, 60, 0, 0, 8, {12, -5}, s, 3);
    CHECK(r.tracks == 300);
    CHECK_FALSE(r.persists);
    CHECK(r.memory_frames == 0);
    CHECK(within(r.d_px2_s, 8));
    CHECK(r.d_px2_s.se < 0.6);
    CHECK(within(r.drift_x_px_s, 12));
    CHECK(within(r.drift_y_px_s, -5));
    // The error of the offset is about that of the first MSD: 4 (D dt + s^2) sqrt(2 / pairs), pairs 17 000.
    CHECK(std::fabs(r.diffusion.offset_px2 - 4 * s * s) <
          12 * (8 * kFrame + s * s) * std::sqrt(2.0 / 17000) * 4);
    if (s < 1) CHECK(r.alpha.value == doctest::Approx(1).epsilon(0.06));
  }
}

TEST_CASE(
    "swimming: speed and persistence time are recovered, and the walk is distinguished from diffusion") {
  // tau = 1 / Dr in two dimensions: MSD = 2 v^2 tau^2 (t / tau - 1 + exp(-t / tau)).
  const TrackSummary r = walk(300, 60, 40, 1.0, 0, {}, 0.4, 5);
  CHECK(r.persists);
  CHECK(within(r.speed_rms_px_s, 40));
  CHECK(r.speed_rms_px_s.se < 1);
  CHECK(within(r.tau_s, 1.0));
  CHECK(r.localisation_px == doctest::Approx(0.4).epsilon(0.3));
  CHECK(r.alpha.value > 1.5);
  CHECK(r.mean_speed_px_s.value == doctest::Approx(40).epsilon(0.03));
}

TEST_CASE("mean speed is corrected for the localisation error") {
  for (const double s : {0.0, 0.3, 1.0}) {
    CAPTURE(s);
    // Three frames: 6 px, error up to a sixth of it; chords are shorter than arcs by Dr T / 6 = 0.25 %.
    const TrackSummary r = walk(400, 40, 40, 0.1, 0, {}, s, 7, 3);
    CHECK(r.mean_speed_px_s.value == doctest::Approx(40).epsilon(0.01));
    CHECK(r.interval_frames == 3);
    CHECK(r.interval_s == doctest::Approx(0.15));
    double all = 0;
    for (const double c : r.speeds_px_s.counts) all += c;
    CHECK(all > 0.99 * double(r.speed_count));
    CHECK(r.speed_quantiles_px_s[1] == doctest::Approx(40).epsilon(0.02));
  }
}

TEST_CASE("circular motion: rate of turn, clockwise positive with y down") {
  cells::Dice dice(1);
  TrackStatistics statistics(kFrame, 1);
  for (int i = 0; i < 40; ++i) {
    Track t;
    t.number = std::uint64_t(i + 1);
    const double phase = 6.28 * dice.uniform();
    for (int k = 0; k < 50; ++k) {
      const double a = phase + 2.0 * k * kFrame;  // 2 rad/s
      t.points.push_back({std::uint64_t(k), k * kFrame, 20 * std::cos(a), 20 * std::sin(a), 1, 1});
    }
    statistics.take(t);
  }
  const TrackSummary r = statistics.summary();
  CHECK(r.signed_turn_deg_s.value == doctest::Approx(2.0 * 180 / std::numbers::pi).epsilon(0.01));
  CHECK(r.turn_deg_s.value == doctest::Approx(2.0 * 180 / std::numbers::pi).epsilon(0.01));
}

TEST_CASE("positions correlated over frames are detected and not mistaken for swimming") {
  cells::Dice dice(6);
  TrackStatistics statistics(kFrame);
  for (int i = 0; i < 300; ++i) {
    Track t;
    t.number = std::uint64_t(i + 1);
    Vec2 p, smeared;
    for (int k = 0; k < 100; ++k) {
      p = p + std::sqrt(2 * 8 * kFrame) * Vec2{dice.normal(), dice.normal()};
      smeared = smeared + 0.6 * (p - smeared);  // as by a codec that updates blocks with a delay
      t.points.push_back({std::uint64_t(k), k * kFrame, smeared.x, smeared.y, 1, 1});
    }
    statistics.take(t);
  }
  const TrackSummary r = statistics.summary();
  CHECK_FALSE(r.persists);
  CHECK(r.memory_frames >= 2);
  CHECK(r.d_px2_s.value == doctest::Approx(8).epsilon(0.08));
}

TEST_CASE("the fit of a mean-square displacement reports when the law does not describe it") {
  // Particles that diffuse in a trap: MSD = 4 s^2 (1 - exp(-t / tau)), with D = s^2 / tau at short times.
  const auto trapped = [](double tau_s, std::uint64_t seed) {
    cells::Dice dice(seed);
    TrackStatistics statistics(kFrame);
    const double sd = 2, keep = std::exp(-kFrame / tau_s);
    for (int i = 0; i < 100; ++i) {
      Track t;
      t.number = std::uint64_t(i + 1);
      Vec2 p = sd * Vec2{dice.normal(), dice.normal()};
      for (int k = 0; k < 80; ++k) {
        t.points.push_back({std::uint64_t(k), k * kFrame, p.x, p.y, 1, 1});
        p = keep * p + sd * std::sqrt(1 - keep * keep) * Vec2{dice.normal(), dice.normal()};
      }
      statistics.take(t);
    }
    return statistics.summary();
  };
  const TrackSummary trap = trapped(5 * kFrame, 1);
  CHECK(trap.diffusion_misfit.significant);
  CHECK(trap.diffusion_misfit.deviation < -0.1);  // it saturates
  int false_alarms = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const TrackSummary free = walk(80, 50, 0, 0, 8, {3, 1}, 0.5, 20 + seed);
    false_alarms += free.diffusion_misfit.significant;
    false_alarms += walk(80, 50, 40, 1, 0, {}, 0.3, 40 + seed).persistent_misfit.significant;
  }
  CHECK(false_alarms <= 1);  // each with a probability below 1 %
}

TEST_CASE("no track, one point: a summary without undefined values") {
  TrackStatistics none(kFrame);
  CHECK(none.summary().tracks == 0);
  TrackStatistics one(kFrame);
  Track t;
  t.number = 1;
  t.points.push_back({0, 0, 1, 1, 1, 1});
  one.take(t);
  const TrackSummary r = one.summary();
  CHECK(r.tracks == 1);
  CHECK(r.msd.size() == 0);
  CHECK_FALSE(r.persists);
}
