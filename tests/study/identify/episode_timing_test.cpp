#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/units.h"
#include "study/identify/episode_simulation.h"

using namespace faba;

namespace {

constexpr double kFps = 10;

ResponseVideo small_video() {
  ResponseVideo v;
  v.fps = kFps;
  v.um_per_px = 1;
  v.cell_px = 3;
  v.view.width = v.view.height = 400;
  return v;
}

Episode episode_of(std::vector<FieldSegment> segments) {
  Episode e;
  e.segments = std::move(segments);
  for (int i = 0; i < 400; ++i) e.positions_image.push_back({160.0 + 4 * (i % 20), 160.0 + 4 * (i / 20)});
  return e;
}

Document scenario_of(const Episode& e, const SegmentTiming& timing) {
  EpisodeSettings settings;
  settings.boundary = Boundary::box;
  settings.field_strength_t = 115e-6;  // 5 px per iteration
  settings.model = {.name = "basic", .part = {{"type", "basic"}, {"max_speed", 2}}};
  Document d = episode_scenario(small_video(), e, settings, timing);
  d.root.erase("microscope");  // its background is the video
  return d;
}

std::vector<double> starts_in_frames(const Document& d) {
  std::vector<double> frames;
  for (const Json& s : d.root["controller"]["segment"])
    frames.push_back(kFps * parse_quantity(s["at"].get<std::string>()).value);
  return frames;
}

double mean_x(const std::vector<Vec2>& positions) {
  double sum = 0;
  for (const Vec2 at : positions) sum += at.x / double(positions.size());
  return sum;
}

std::vector<std::pair<double, double>> pairs(const std::vector<Vec2>& positions) {
  std::vector<std::pair<double, double>> out;
  for (const Vec2 at : positions) out.push_back({at.x, at.y});
  return out;
}

std::vector<std::pair<double, double>> sorted(const std::vector<Vec2>& positions) {
  auto out = pairs(positions);
  std::ranges::sort(out);
  return out;
}

}  // namespace

TEST_CASE("reversals between frames are simulated at the nearest frame") {
  const Episode e = episode_of({{0.02, 1.04, 0}, {1.04, 2.06, 180}, {2.06, 3, 0}});
  const Document d = scenario_of(e, exact_timing(e));
  const std::vector<double> frames = starts_in_frames(d);
  REQUIRE(frames.size() == 2);  // the first segment starts with the episode
  CHECK(frames[0] == doctest::Approx(10));
  CHECK(frames[1] == doctest::Approx(21));
}

TEST_CASE("the last of several segments that start at the same frame counts") {
  const Episode e = episode_of({{0, 1, 0}, {1, 2, 180}, {2, 3, 0}});
  const Document d = scenario_of(e, {.lead_s = 0, .starts_s = {0, 1.01, 1.02}});
  CHECK(starts_in_frames(d).size() == 1);
  CHECK(d.root["controller"]["segment"][0]["field"] == d.root["controller"]["field"]);
  CHECK_NOTHROW((void)read_scenario(d, builtin_parts()));
}

TEST_CASE("sampled times of field reversals are unbiased, and the phase of the clock of a model is uniform") {
  const Episode e = episode_of({{0, 1, 0}, {1, 2, 180}});
  constexpr int kSamples = 4000;
  std::vector<int> phases(2);
  double first = 0, second = 0;
  for (int i = 0; i < kSamples; ++i) {
    const SegmentTiming t = random_timing(
        e, {.sd_s = 0.058, .frame_s = 1 / kFps, .clock_frames = 2, .history_frames = 6}, std::uint64_t(i));
    const double lead = t.lead_s * kFps;
    REQUIRE(lead > 5.5);
    REQUIRE(lead == doctest::Approx(std::round(lead)));
    ++phases[std::size_t(std::lround(lead)) % 2];
    first += (std::round(t.starts_s[0] * kFps) - lead) / kSamples;
    second += (std::round(t.starts_s[1] * kFps) - lead - 10) / kSamples;
  }
  // 4 standard errors; the spread of a rounded time is 0.65 frames.
  const double tolerance = 4 * 0.65 / std::sqrt(kSamples);
  CHECK(std::fabs(first) < tolerance);
  CHECK(std::fabs(second) < tolerance);
  CHECK(std::abs(phases[0] - kSamples / 2) < 4 * std::sqrt(kSamples / 4));
}

TEST_CASE("an episode starts at the measured positions, with the velocities of the frames before it") {
  const Episode e = episode_of({{0, 2, 0}});
  const auto seen = [&](int lead_frames) {
    const double lead_s = lead_frames / kFps;
    const Document d = scenario_of(e, {.lead_s = lead_s, .starts_s = {lead_s}});
    return simulate_episode(read_scenario(d, builtin_parts()), 1, {lead_s, 0}, {0, 1 / kFps, 2 / kFps},
                            Look::positions, nullptr)
        .positions;
  };
  const auto at_once = seen(0), later = seen(1);
  CHECK(sorted(later[0]) == sorted(at_once[0]));
  // A velocity is kept for two iterations: with one frame of lead the cells first move against the new field.
  CHECK(mean_x(at_once[1]) - mean_x(at_once[0]) > 3);
  CHECK(mean_x(later[1]) - mean_x(later[0]) < -3);
  CHECK(mean_x(later[2]) - mean_x(later[1]) > 3);
}

TEST_CASE("places are rearranged within strips along the direction, in the order of the cells") {
  const std::vector<Vec2> places{{0, 0}, {1, 0}, {0, 10}, {1, 10}};
  // The cells of each row have changed their order along x; their rows are displaced.
  const std::vector<Vec2> like{{7, 1}, {5, 0}, {3, 12}, {9, 11}};
  const auto check = [](const std::vector<Vec2>& found, const std::vector<Vec2>& expected) {
    CHECK(pairs(found) == pairs(expected));
  };
  check(rearranged(places, like, 0), {{1, 0}, {0, 0}, {0, 10}, {1, 10}});
  check(rearranged(places, like, 180), {{1, 0}, {0, 0}, {0, 10}, {1, 10}});
  // Along y, strips have equal x.
  check(rearranged(places, {{0, 4}, {1, 6}, {0, 3}, {1, 8}}, 90), {{0, 10}, {1, 0}, {0, 0}, {1, 10}});
  CHECK(rearranged({}, {}, 0).empty());
}

// In the history slow cells fall behind: cells that start independently of their speed would spread more.
TEST_CASE("after a history in the opposite field slow cells are in front of fast ones") {
  const Episode e = episode_of({{0, 2, 0}});
  const auto spread = [&](int history_frames) {
    const double lead_s = history_frames / kFps;
    Document d = scenario_of(e, {.lead_s = lead_s, .starts_s = {lead_s}});
    d.root["swarm"][0]["model"] = {{"type", "adapted"}, {"max_speed", 4}, {"noise_amplitude", 0}};
    const auto last =
        simulate_episode(read_scenario(d, builtin_parts()), 1, {lead_s, 0}, {1.2}, Look::positions, nullptr)
            .positions[0];
    double square = 0;
    for (const Vec2 at : last) square += std::pow(at.x - mean_x(last), 2) / double(last.size());
    return std::sqrt(square);
  };
  CHECK(spread(20) < 0.8 * spread(0));
}
