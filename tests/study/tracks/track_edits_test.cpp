#include "study/tracks/track_edits.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/error.h"

using namespace faba;

namespace {

// A track along x with `speed` px per frame of 0.1 s.
Track straight(std::uint64_t number, std::uint64_t first, int points, double speed, double y = 0) {
  Track t;
  t.number = number;
  for (int i = 0; i < points; ++i) {
    const std::uint64_t frame = first + std::uint64_t(i);
    t.points.push_back({frame, 0.1 * double(frame), speed * i, y, 100, 10});
  }
  return t;
}
double value(const TrackFeatures& f, TrackFeature which) { return f[std::size_t(which)]; }

std::vector<Track> measured() {
  return {straight(1, 0, 21, 1), straight(2, 0, 10, 3, 50), straight(3, 12, 9, 3, 50), straight(5, 0, 4, 0)};
}
std::vector<TrackFate> fates(const std::vector<EditedTrack>& tracks) {
  std::vector<TrackFate> all;
  for (const EditedTrack& t : tracks) all.push_back(t.fate);
  return all;
}

}  // namespace

TEST_CASE("track features of known paths") {
  const TrackFeatures f = features_of(straight(1, 0, 21, 2), 0.1, 4);
  CHECK(value(f, TrackFeature::speed) == doctest::Approx(20));
  CHECK(value(f, TrackFeature::duration) == doctest::Approx(2));
  CHECK(value(f, TrackFeature::points) == 21);
  CHECK(value(f, TrackFeature::displacement) == doctest::Approx(40));
  CHECK(value(f, TrackFeature::path) == doctest::Approx(40));
  CHECK(value(f, TrackFeature::straightness) == doctest::Approx(1));
  CHECK(value(f, TrackFeature::turning) == doctest::Approx(0));
  CHECK(value(f, TrackFeature::snr) == doctest::Approx(10));

  Track circle;  // 10 deg per frame: 100 deg/s, whatever the interval
  for (int i = 0; i <= 36; ++i) {
    const double a = i * 10 * 3.14159265358979 / 180;
    circle.points.push_back({std::uint64_t(i), 0.1 * i, 30 * std::cos(a), 30 * std::sin(a), 1, 5});
  }
  for (const int interval : {1, 3}) {
    const TrackFeatures c = features_of(circle, 0.1, interval);
    CHECK(value(c, TrackFeature::turning) == doctest::Approx(100).epsilon(1e-6));
    CHECK(value(c, TrackFeature::straightness) == doctest::Approx(0).epsilon(1e-6));
  }
  // Shorter than the interval: the speed between its ends, no turning.
  const TrackFeatures s = features_of(straight(1, 0, 3, 2), 0.1, 5);
  CHECK(value(s, TrackFeature::speed) == doctest::Approx(20));
  CHECK(std::isnan(value(s, TrackFeature::turning)));
  CHECK(std::isnan(value(features_of(straight(1, 0, 1, 2), 0.1, 1), TrackFeature::speed)));
}

TEST_CASE("track edits: cuts include their limits, and changes by hand have precedence") {
  TrackEdits e;
  e.cuts = {{TrackFeature::points, 9.0, {}}, {TrackFeature::speed, {}, 15.0}};
  using enum TrackFate;
  CHECK(fates(edited_tracks(measured(), e, 0.1, 1)) == std::vector{passes, cut, cut, cut});
  e.cuts[1].max = 31;
  CHECK(fates(edited_tracks(measured(), e, 0.1, 1)) == std::vector{passes, passes, passes, cut});
  e.edits = {{TrackEditKind::remove, 1, 0, 0}, {TrackEditKind::keep, 5, 0, 0}};
  CHECK(fates(edited_tracks(measured(), e, 0.1, 1)) == std::vector{removed, passes, passes, kept});
  // Straightness of a cell that does not move is not defined, and does not pass.
  TrackEdits s;
  s.cuts = {{TrackFeature::straightness, 0.0, {}}};
  CHECK(edited_tracks(measured(), s, 0.1, 1).back().fate == cut);
}

TEST_CASE("track edits: split and join") {
  TrackEdits e;
  e.edits = {
      {TrackEditKind::join, 2, 0, 3}, {TrackEditKind::split, 1, 8, 0}, {TrackEditKind::remove, 6, 0, 0}};
  const std::vector<EditedTrack> all = edited_tracks(measured(), e, 0.1, 1);
  REQUIRE(all.size() == 4);
  CHECK(all[0].track.points.size() == 8);
  CHECK(all[1].track.number == 2);
  CHECK(all[1].track.points.size() == 19);
  CHECK(all[1].track.points.back().frame == 20);
  CHECK(all[3].track.number == 6);  // the next free number
  CHECK(all[3].track.points.front().frame == 8);
  CHECK(all[3].fate == TrackFate::removed);
  // Joining in the other order gives the same detections.
  TrackEdits back;
  back.edits = {{TrackEditKind::join, 3, 0, 2}};
  CHECK(edited_tracks(measured(), back, 0.1, 1)[1].track.points.front().frame == 0);

  const auto refused = [](TrackEdit edit) {
    TrackEdits one;
    one.edits = {edit};
    CHECK_THROWS_AS((void)edited_tracks(measured(), one, 0.1, 1), Error);
  };
  refused({TrackEditKind::remove, 4, 0, 0});
  refused({TrackEditKind::split, 1, 0, 0});
  refused({TrackEditKind::split, 1, 21, 0});
  refused({TrackEditKind::join, 1, 0, 2});  // at the same time
  refused({TrackEditKind::join, 1, 0, 1});
  refused({TrackEditKind::join, 1, 0, 99});
}

TEST_CASE("track edits: the motion is that of the used tracks") {
  std::vector<Track> tracks;
  for (std::uint64_t n = 1; n <= 60; ++n)
    tracks.push_back(straight(n, 0, 40, n <= 20 ? 5 : 1, 10 * double(n)));
  const auto speed = [&](const TrackEdits& e) {
    return motion_of(edited_tracks(tracks, e, 0.1, 1), tracks, 0.1, 1, false);
  };
  CHECK(speed({}).summary.tracks == 60);
  TrackEdits fast;
  fast.cuts = {{TrackFeature::speed, 30.0, {}}};
  const SelectedMotion m = speed(fast);
  CHECK(m.summary.tracks == 20);
  CHECK(m.summary.mean_speed_px_s.value == doctest::Approx(50).epsilon(1e-3));
}
