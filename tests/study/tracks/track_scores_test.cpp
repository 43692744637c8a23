#include "study/tracks/track_scores.h"

#include <doctest/doctest.h>

#include "tests/study/tracks/spot_at.h"

using namespace faba;

TEST_CASE("track scores: long tracks without gaps are near 1, gaps and short tracks reduce the score") {
  TrackerOptions options;
  options.search_radius_px = 10;
  options.motion = Motion::nearest;
  Tracker tracker(options);
  LinkCheck check(options);
  TrackScores scores;
  const auto emit = [&] {
    for (const Track& t : tracker.finished()) {
      check.track(t);
      scores.take(t);
    }
  };
  for (int i = 0; i < 80; ++i) {
    std::vector<Spot> spots{spot_at(10 + i, 20)};
    if (i % 2 == 0) spots.push_back(spot_at(10 + i, 120));  // seen in every second frame
    if (i < 4) spots.push_back(spot_at(10 + i, 220));
    tracker.take(std::uint64_t(i), 0.1 * i, spots);
    check.take(std::uint64_t(i), 0.1 * i, spots);
    emit();
  }
  tracker.finish();
  emit();
  REQUIRE(check.reproduced());
  const std::vector<TrackScore> all = scores.scores(check);
  REQUIRE(all.size() == 3);
  const auto of_points = [&](std::uint64_t points) {
    for (const TrackScore& s : all)
      if (s.points == points) return s;
    FAIL("no such track");
    return TrackScore{};
  };
  const TrackScore good = of_points(80), gaps = of_points(40), brief = of_points(4);
  CHECK(good.links_tested > 15);
  CHECK(good.links_reproduced == good.links_tested);
  CHECK(*good.score > 0.9);
  CHECK(good.path_px == doctest::Approx(79));
  CHECK(good.distance_px == doctest::Approx(79));
  CHECK(*gaps.score < 0.55);  // half of the frames
  CHECK(*brief.score < 0.7);  // at most one link was tested
  const ScoreSummary s = summary_of(all);
  REQUIRE(s.mean);
  CHECK(*s.mean == doctest::Approx((80 * *good.score + 40 * *gaps.score + 4 * *brief.score) / 124));
  CHECK_FALSE(summary_of({}).mean);
}
