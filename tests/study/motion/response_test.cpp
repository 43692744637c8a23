// Responding fraction and speed at the frame rate of the thesis, from rendered videos with known truth.
#include "study/motion/response.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "study/motion/activity_checks.h"
#include "study/motion/response_frames.h"
#include "tests/rendered_video.h"
#include "tests/temporary_folder.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

constexpr double kReversal = 1;  // s

/// Straight paths on a torus around the view, so that the number of cells in view is constant. Cells that
/// respond swim to the left before the reversal and to the right after it, others in random directions.
RenderedVideo swarm(int count, double responding, double speed_px_s, std::uint64_t seed) {
  struct Swimmer {
    Vec2 start, velocity;
    bool responds;
  };
  const double margin = 40;
  RenderedVideo v;
  v.frames = 45;
  v.seed = seed;
  v.microscope.cell_diameter = 2.5e-6;
  cells::Dice dice(seed);
  std::vector<Swimmer> all;
  for (int i = 0; i < count; ++i) {
    const double speed = speed_px_s * (1 + 0.24 * dice.normal()), angle = 2 * M_PI * dice.uniform();
    const Vec2 start{(v.width + 2 * margin) * dice.uniform(), (v.height + 2 * margin) * dice.uniform()};
    const bool responds = i < responding * count;
    all.push_back(
        {start, responds ? Vec2{speed, 0} : speed * Vec2{std::cos(angle), std::sin(angle)}, responds});
  }
  v.cells = [all, v, margin](double t) {
    std::vector<CameraCell> out;
    for (const Swimmer& s : all) {
      const double path = s.responds ? std::fabs(t - kReversal) : t;
      const auto wrapped = [&](double x, double size) {
        return x - (size + 2 * margin) * std::floor(x / (size + 2 * margin)) - margin;
      };
      out.push_back({float(wrapped(s.start.x + path * s.velocity.x, v.width)),
                     float(wrapped(s.start.y + path * s.velocity.y, v.height))});
    }
    return out;
  };
  return v;
}

/// Cells on the dark line along the edge of a drop, with a distance in px. Every second one leaves it to the
/// right after the reversal; the others stay.
RenderedVideo at_the_edge(double speed_px_s, double distance, double radius = 550) {
  RenderedVideo v;
  v.frames = 60;
  v.microscope.cell_diameter = 2.5e-6;
  v.edge = {{40 + radius, 119.5}, radius};
  cells::Dice dice(7);
  std::vector<Vec2> starts;
  std::vector<double> speeds;
  const double half = std::min(100.0, 0.7 * radius);
  for (double y = 120 - half; y < 120 + half; y += distance) {
    const double depth = 1 + dice.uniform(), inner = v.edge.radius - depth, dy = y - v.edge.centre.y;
    starts.push_back({v.edge.centre.x - std::sqrt(inner * inner - dy * dy), y});
    speeds.push_back(starts.size() % 2 ? speed_px_s * (1 + 0.24 * dice.normal()) : 0);
  }
  v.cells = [starts, speeds](double t) {
    std::vector<CameraCell> out;
    for (std::size_t i = 0; i < starts.size(); ++i)
      out.push_back({float(starts[i].x + std::max(0.0, t - kReversal) * speeds[i]), float(starts[i].y)});
    return out;
  };
  return v;
}

std::optional<Response> measured(const RenderedVideo& v, double direction_deg = 0,
                                 double reversal_s = kReversal, std::optional<double> objects = {}) {
  const test::TemporaryFolder folder("response");
  write_rendered(v, folder.path() / "v.avi");
  ResponseJob job;
  job.video = folder.path() / "v.avi";
  job.reversal_s = reversal_s;
  job.direction_deg = direction_deg;
  job.frame_s = 1 / v.fps;
  job.objects = objects;
  job.threads = 1;
  return measure_response(job);
}

}  // namespace

// 186 um/s at 0.92 um per px and 15 frames per second.
TEST_CASE("response: fraction and speed of cells that move by 13 px between frames") {
  for (const double fraction : {0.5, 0.8}) {
    const double speed = 202;
    const auto r = measured(swarm(200, fraction, speed, 3));
    REQUIRE(r);
    CHECK(r->responds);
    REQUIRE(r->flow);
    CHECK_FALSE(r->flow->valid());
    REQUIRE(r->fraction);
    CHECK(std::fabs(r->fraction->value - fraction) < 0.1);
    REQUIRE(r->speed_px_s);
    CHECK(std::fabs(r->speed_px_s->value / speed - 1) < 0.1);
  }
}

TEST_CASE("response: none of cells that swim in random directions") {
  const auto r = measured(swarm(200, 0, 202, 4));
  REQUIRE(r);
  CHECK_FALSE(r->responds);
  REQUIRE(r->fraction);
  CHECK(r->fraction->value == 0);
  CHECK_FALSE(r->speed_px_s);
}

// Cells absorb less light on the dark edge, and overlap. The fraction must not depend on either.
TEST_CASE("response: cells that stay on the dark edge of a drop are as many as those that leave it") {
  const double speed = 60;
  for (const double distance : {3.0, 4.0, 6.0, 9.0, 12.0}) {
    CAPTURE(distance);
    const auto r = measured(at_the_edge(speed, distance));
    REQUIRE(r);
    REQUIRE(r->fraction);
    CHECK(std::fabs(r->fraction->value - 0.5) < 0.1);
    REQUIRE(r->speed_px_s);
    CHECK(std::fabs(r->speed_px_s->value / speed - 1) < 0.1);
  }
}

// In a small drop cells on the edge count too little, by an amount that depends on their distances.
TEST_CASE("response: much that stays at the edge of a drop is named") {
  for (const double radius : {100.0, 150.0, 240.0, 550.0})
    for (const double distance : {4.0, 6.0, 12.0}) {
      CAPTURE(radius);
      CAPTURE(distance);
      const auto r = measured(at_the_edge(60, distance, radius));
      REQUIRE(r);
      REQUIRE(r->fraction);
      REQUIRE(edge_warning(*r));
      CHECK(edge_warning(*r)->quality == Quality::doubtful);
    }
}

// The dark line of the edge, 27 sizes of a cell in radius, is longer than the cells together. The limit, here
// and below, is the goal of bench/ageing.py: within 0.1 of the true fraction, 1.
TEST_CASE("response: the edge of a small drop does not count as objects") {
  RenderedVideo v = swarm(60, 1, 60, 6);
  v.edge = {{159.5, 119.5}, 80};
  const auto inside = v.cells;
  v.cells = [inside, v](double t) {
    std::vector<CameraCell> all = inside(t), some;
    for (const CameraCell& c : all)
      if (norm(Vec2{c.x, c.y} - v.edge.centre) < v.edge.radius - 5) some.push_back(c);
    return all;
  };
  const auto r = measured(v);
  REQUIRE(r);
  REQUIRE(r->fraction);
  CHECK(r->fraction->value > 0.9);
  CHECK_FALSE(edge_warning(*r));
}

// The background fades as well, by less than a grey level between two pictures.
TEST_CASE("response: fluorescence that fades does not change the fraction") {
  RenderedVideo v = swarm(60, 1, 60, 6);
  v.microscope.mode = MicroscopeParams::Mode::fluorescence;
  v.microscope.bleaching_time = 1;
  const auto r = measured(v);
  REQUIRE(r);
  REQUIRE(r->fraction);
  CHECK(r->fraction->value > 0.9);
}

// Most cells swim in random directions. Two fifths of them are within 35 degrees of the axis of the response,
// and their numbers in both ways differ at random. The root mean square of eight such errors is above 1.4
// times its expected value once in 20 times (chi-square).
TEST_CASE("response: a quarter of the cells of an old sample respond") {
  constexpr int kSamples = 8, kCells = 180;
  constexpr double kFraction = 0.25, kInView = 0.6 * kCells, kSpeed = 55;
  double sum = 0, squares = 0;
  for (std::uint64_t seed = 1; seed <= kSamples; ++seed) {
    const auto r = measured(swarm(kCells, kFraction, kSpeed, seed));
    REQUIRE(r);
    REQUIRE(r->fraction);
    REQUIRE(r->speed_px_s);
    // Three standard errors of the mean of 27 speeds that differ by 24 %.
    CHECK(std::fabs(r->speed_px_s->value / kSpeed - 1) < 0.15);
    sum += r->fraction->value - kFraction;
    squares += std::pow(r->fraction->value - kFraction, 2);
  }
  const double at_random = std::sqrt(0.4 * (1 - kFraction) / kInView);
  CHECK(std::fabs(sum / kSamples) < 2 * at_random / std::sqrt(kSamples));
  CHECK(std::sqrt(squares / kSamples) < 1.4 * at_random);
}

// The same cells swim the other way before the reversal. The error of the mean of two independent fractions
// is smaller by the square root of 2; these cells keep their directions, so that it is smaller still.
TEST_CASE("response: the mean of the fractions before and after the reversal has a smaller error") {
  constexpr int kSamples = 8, kCells = 180;
  constexpr double kFraction = 0.25, kInView = 0.6 * kCells;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= kSamples; ++seed) {
    const auto r = measured(swarm(kCells, kFraction, 55, seed), 0, kReversal, kInView);
    REQUIRE(r);
    REQUIRE(r->fraction);
    CHECK(r->fraction_method == "image correlation before and after the reversal");
    CHECK(r->fraction->ci90[0] < kFraction);
    CHECK(r->fraction->ci90[1] > kFraction);
    squares += std::pow(r->fraction->value - kFraction, 2);
  }
  CHECK(std::sqrt(squares / kSamples) < 1.4 * std::sqrt(0.4 * (1 - kFraction) / kInView / 2));
}

// Cells that wait, as at an edge outside of the picture, have no fraction before the reversal.
TEST_CASE(
    "response: the fraction of cells that do not swim the other way before is that after the reversal") {
  for (const double fraction : {0.25, 0.4, 0.8}) {
    RenderedVideo v = swarm(180, fraction, 55, 2);
    const auto moving = v.cells;
    const std::size_t responding = std::size_t(std::ceil(fraction * 180));
    v.cells = [moving, responding](double t) {
      std::vector<CameraCell> all = moving(t);
      const std::vector<CameraCell> waiting = moving(std::max(t, kReversal));
      std::copy_n(waiting.begin(), responding, all.begin());
      return all;
    };
    const auto both = measured(v, 0, kReversal, 108.0), after = measured(v);
    REQUIRE((both && both->fraction && after && after->fraction));
    CHECK(both->fraction_method == "image correlation");
    CHECK(both->fraction->value == after->fraction->value);
    // Three standard deviations of the cells that swim in random directions, as above.
    CHECK(std::fabs(both->fraction->value - fraction) < 3 * std::sqrt(0.4 * (1 - fraction) / 108));
  }
}

// Both within half of the goals of bench/ageing.py.
TEST_CASE("response: the fraction does not depend on an error of the direction of 15 degrees") {
  const RenderedVideo v = swarm(180, 0.8, 55, 5);
  const auto exact = measured(v), off = measured(v, 15);
  REQUIRE((exact && exact->fraction && exact->speed_px_s));
  REQUIRE((off && off->fraction && off->speed_px_s));
  CHECK(std::fabs(off->fraction->value - exact->fraction->value) < 0.05);
  CHECK(std::fabs(off->speed_px_s->value / exact->speed_px_s->value - 1) < 0.05);
}

TEST_CASE("response: a wrong direction and a wrong time are named, and no response is without warning") {
  for (const double direction : {90, 180}) {
    const auto r = measured(swarm(200, 0.8, 202, 3), direction);
    REQUIRE(r);
    CHECK_FALSE(r->responds);
    REQUIRE(r->other_direction_deg);
    CHECK(std::fabs(std::remainder(*r->other_direction_deg, 360)) < 30);
    const auto warning = no_response_warning(*r);
    REQUIRE(warning);
    CHECK(warning->aspect == "direction");
    CHECK(warning->quality == Quality::poor);
  }
  RenderedVideo longer = swarm(200, 0.8, 202, 3);
  longer.frames = 75;
  const auto late = measured(longer, 0, 2.5);
  REQUIRE(late);
  CHECK_FALSE(late->responds);
  const auto warning = no_response_warning(*late);
  REQUIRE(warning);
  CHECK(warning->aspect == "timing");
  const auto none = measured(swarm(200, 0, 202, 4));
  REQUIRE(none);
  CHECK_FALSE(no_response_warning(*none));
}

TEST_CASE("response frames: pictures that are kept and pictures that are read again are equal") {
  const test::TemporaryFolder f("response-frames");
  const std::filesystem::path video = f.path() / "v.avi";
  write_rendered(swarm(60, 0.8, 60, 5), video);
  const VideoPart part{0.2, 1.0, 0}, longer{0.2, 1.4, 0};
  const auto pictures = [](const ResponseFrames& frames, const VideoPart& of) {
    std::vector<std::vector<float>> slots(frames.slots()), all;
    frames.each(
        of, [&](std::size_t slot, const GrayF& objects, double) { slots[slot] = objects.px; },
        [&](std::size_t slot) { all.push_back(slots[slot]); });
    return all;
  };
  const auto none = std::make_shared<ResponsePictures>(part, 0);
  const ResponseFrames kept(video, part, 2, [] {}), read(
                                                        video, part, 2, [] {}, none);
  CHECK(kept.frames() == read.frames());
  CHECK(kept.object_px() == read.object_px());
  CHECK(kept.noise() == read.noise());
  const auto expected = pictures(kept, part);
  CHECK(expected.size() == std::size_t(kept.frames()));
  CHECK(pictures(read, part) == expected);
  // Beyond the part of the constructor they are read.
  auto beyond = pictures(kept, longer);
  CHECK(beyond.size() > expected.size());
  CHECK(beyond == pictures(read, longer));
  beyond.resize(expected.size());
  CHECK(beyond == expected);
  VideoPart to_the_end = part;
  to_the_end.to_s.reset();
  CHECK(pictures(kept, to_the_end).size() > expected.size());
  // Pictures of a longer part, taken beside other work.
  const auto taken = std::make_shared<ResponsePictures>(longer);
  int others = 0;
  const FrameInspector other{[](double) { return true; },
                             [&](const GrayF&) {
                               ++others;
                               return std::function<void()>();
                             }};
  inspect_video(video, VideoPart{}, both(taken->inspector(), other), 2, [](auto, auto) {});
  CHECK(others == 45);
  REQUIRE(taken->hold(part));
  const ResponseFrames given(
      video, part, 2, [] {}, taken);
  CHECK(given.frames() == read.frames());
  CHECK(given.noise() == read.noise());
  CHECK(pictures(given, part) == expected);
}

TEST_CASE("response pictures: none are kept that need more memory, and none of another part are given") {
  const test::TemporaryFolder f("response-pictures");
  const std::filesystem::path video = f.path() / "v.avi";
  write_rendered(swarm(60, 0.8, 60, 5), video);
  const VideoPart part{0.2, 1.0, 0};
  ResponsePictures few(part, 5 * sizeof(float) * 320 * 240), all(part);
  inspect_video(video, part, both(few.inspector(), all.inspector()), 1, [](auto, auto) {});
  CHECK(few.all().empty());
  CHECK_FALSE(few.hold(part));
  CHECK(all.hold(part));
  CHECK_FALSE(all.hold(VideoPart{0.1, 1.0, 0}));
  CHECK_FALSE(all.hold(VideoPart{0.2, 1.1, 0}));
  CHECK_FALSE(all.hold(VideoPart{0.2, {}, 0}));
  CHECK_FALSE(all.hold(VideoPart{0.2, 1.0, 30}));
}
