#include "study/tracks/link_check.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/random/philox.h"
#include "tests/study/tracks/spot_at.h"

using namespace faba;

namespace {

double uniform_at(std::uint32_t a, std::uint32_t b) {
  return double(draw(3, Stream::study, a, b)[0]) / 0x1p32;
}

// Links the frames of `spots_in` by a tracker and by the check.
template <class Spots>
double reproduced(int frames, const Spots& spots_in) {
  TrackerOptions options;
  options.search_radius_px = 12;
  options.motion = Motion::nearest;
  Tracker tracker(options);
  LinkCheck check(options);
  for (int i = 0; i < frames; ++i) {
    const std::vector<Spot> spots = spots_in(i);
    tracker.take(std::uint64_t(i), 0.1 * i, spots);
    check.take(std::uint64_t(i), 0.1 * i, spots);
    for (const Track& t : tracker.finished()) check.track(t);
  }
  tracker.finish();
  for (const Track& t : tracker.finished()) check.track(t);
  const auto fraction = check.reproduced();
  REQUIRE(fraction);
  return *fraction;
}

}  // namespace

TEST_CASE("links of objects far apart are reproduced without every fourth frame") {
  const double fraction = reproduced(60, [](int i) {
    std::vector<Spot> spots;
    for (int k = 0; k < 20; ++k) spots.push_back(spot_at(40.0 * k + 2 * i, 50 + 3 * std::sin(k)));
    return spots;
  });
  CHECK(fraction > 0.99);
}

TEST_CASE("links between random detections are not reproduced") {
  const double fraction = reproduced(60, [](int i) {
    std::vector<Spot> spots;
    for (std::uint32_t k = 0; k < 200; ++k)
      spots.push_back(
          spot_at(200 * uniform_at(std::uint32_t(i), 2 * k), 200 * uniform_at(std::uint32_t(i), 2 * k + 1)));
    return spots;
  });
  CHECK(fraction < 0.5);
}

TEST_CASE("few links are not judged") {
  LinkCheck check(TrackerOptions{});
  check.take(0, 0, {spot_at(1, 1)});
  CHECK(!check.reproduced());
}
