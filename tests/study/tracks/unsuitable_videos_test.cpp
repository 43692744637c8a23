// Videos for which a confident answer would be wrong, with known truth.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

#include "study/tracks/track_measurement.h"
#include "tests/vision/media.h"
#include "tests/vision/rendered_cells.h"
#include "vision/image/kernels/smoothing.h"

using namespace faba;

namespace {

class NoListener final : public TrackListener {
 public:
  void frame(std::uint64_t, double, const GrayF&, const Tracker&) override {}
  void track(const Track&) override {}
};

// Writes the frames and tracks them.
TrackMeasurement tracked(int frames, const std::function<GrayF(int)>& frame, TrackOptions o = {}) {
  const media::ScratchFolder folder;
  for (int k = 0; k < frames; ++k) {
    const Gray8 b = cells::bytes(frame(k));
    media::write_bytes(
        folder / fmt::format("f{:03}.pgm", k),
        fmt::format("P5\n{} {}\n255\n", b.width, b.height) + std::string(b.px.begin(), b.px.end()));
  }
  o.video = folder.path();
  o.part.fps = 10;
  const RunVideo source{o.video, {}};
  const TrackSurvey survey = survey_tracks(o, o.video, [](auto, auto) {});
  NoListener none;
  return measure_tracks(o, source, survey, none, [](auto) {});
}

bool warns(const TrackMeasurement& m, const std::string& aspect) {
  for (const Warning& w : m.warnings)
    if (w.aspect == aspect) return true;
  return false;
}

// Grains with an exponential distribution of contrast on a field larger than the picture.
GrayF grains(const cells::Look& l, int margin, double size_px, double contrast) {
  cells::Dice dice(11);
  GrayF field(l.width + 2 * margin, l.height + 2 * margin);
  for (float& v : field.px) {
    const double n = dice.normal();
    v = float(n * n * n);
  }
  field = smoothed(field, size_px / 2.355);
  double square = 0;
  for (const float v : field.px) square += double(v) * double(v) / double(field.px.size());
  for (float& v : field.px) v = float(double(v) * contrast / std::sqrt(square));
  return field;
}

}  // namespace

TEST_CASE("a textured background that drifts slowly is not a population of good tracks") {
  cells::Look l;
  l.width = 320;  // with fewer than five grains in view a drift is not recognised
  l.height = 240;
  constexpr int kMargin = 20;
  const GrayF texture = grains(l, kMargin, 4, 6);
  for (const double step : {0.1, 0.5}) {
    CAPTURE(step);
    const TrackMeasurement m = tracked(36, [&](int k) {
      GrayF frame = cells::picture(l, {}, std::uint64_t(k));
      const double x = kMargin - step * k, y = kMargin + 0.3 * step * k;
      const int col = int(std::floor(x)), row = int(std::floor(y));
      const double u = x - col, w = y - row;
      for (int r = 0; r < l.height; ++r)
        for (int c = 0; c < l.width; ++c) {
          const auto at = [&](int dc, int dr) { return double(texture.at(col + c + dc, row + r + dr)); };
          frame.at(c, r) += float((1 - u) * (1 - w) * at(0, 0) + u * (1 - w) * at(1, 0) +
                                  (1 - u) * w * at(0, 1) + u * w * at(1, 1));
        }
      for (float& v : frame.px) v = std::clamp(v, 0.0F, 255.0F);
      return frame;
    });
    CHECK(quality_of(m.warnings) != Quality::good);
  }
}

TEST_CASE("a stage that drifts and shakes is subtracted when objects fixed to it are in view") {
  cells::Look l;
  const auto fixed = cells::scattered(l, 20, 16, 60, 3), start = cells::scattered(l, 25, 16, 60, 4);
  cells::Dice dice(8);
  std::vector<double> angle;
  for (std::size_t k = 0; k < start.size(); ++k) angle.push_back(6.283 * dice.uniform());
  std::vector<Vec2> stage;
  for (int k = 0; k < 40; ++k)
    stage.push_back(k * Vec2{0.8, 0.4} + 0.25 * Vec2{dice.normal(), dice.normal()});
  const auto frame = [&](int k) {
    std::vector<Vec2> at;
    for (const Vec2 p : fixed) at.push_back(p + stage[std::size_t(k)]);
    for (std::size_t i = 0; i < start.size(); ++i)
      at.push_back(start[i] + stage[std::size_t(k)] + 1.5 * k * Vec2{std::cos(angle[i]), std::sin(angle[i])});
    return cells::picture(l, at, std::uint64_t(k));
  };
  const TrackMeasurement m = tracked(40, frame);
  CHECK(m.stage.removed);
  CHECK(m.stage.drift_px_s.x == doctest::Approx(8).epsilon(0.03));
  CHECK(warns(m, "drift"));
  REQUIRE(m.populations.size() == 2);
  CHECK(m.populations[0].motion == PopulationMotion::still);
  CHECK(m.populations[1].speed_px_s == doctest::Approx(15).epsilon(0.05));
  TrackOptions kept;
  kept.keep_drift = true;
  const TrackMeasurement n = tracked(40, frame, kept);
  CHECK_FALSE(n.stage.removed);
  CHECK(quality_of(n.warnings) == Quality::doubtful);
}

TEST_CASE("objects of two sizes: the estimated size is ambiguous, a given size is not") {
  cells::Look small, large;
  large.cell_sd_px = 9;
  large.noise = 0;
  large.uneven = small.uneven = false;
  const auto few = cells::scattered(large, 10, 45, 30, 5), many = cells::scattered(small, 40, 12, 10, 6);
  const auto frame = [&](int k) {
    std::vector<Vec2> a = few, b = many;
    for (Vec2& p : a) p.x += 4.0 * k;  // else they become background
    for (Vec2& p : b) p.y += 1.0 * k;
    GrayF out = cells::picture(small, b, std::uint64_t(k));
    const GrayF shade = cells::picture(large, a, 1);
    for (std::size_t i = 0; i < out.px.size(); ++i) out.px[i] *= shade.px[i] / float(large.level);
    return out;
  };
  const TrackMeasurement m = tracked(14, frame);
  CHECK(warns(m, "size"));
  TrackOptions given;
  given.size_px = 3;
  CHECK_FALSE(warns(tracked(14, frame, given), "size"));
}

TEST_CASE("a region restricts background, size and detections; positions are those of the frame") {
  cells::Look l;
  const auto inside = cells::scattered(l, 60, 12, 12, 5);
  std::size_t expected = 0;
  for (const Vec2 p : inside) expected += p.x > 105 && p.x < 295 && p.y > 65 && p.y < 175;
  const auto frame = [&](int k) {
    std::vector<Vec2> at = inside;
    for (Vec2& p : at) p.x += 0.0 * k;
    return cells::picture(l, at, std::uint64_t(k));
  };
  TrackOptions o;
  o.region = PixelRegion{100, 60, 200, 120};
  const TrackMeasurement m = tracked(12, frame, o);
  CHECK(m.detection.searched_px2 == 200 * 120);
  CHECK(m.detection.spots_per_frame == doctest::Approx(double(expected)).epsilon(0.15));
  o.region = PixelRegion{300, 60, 200, 120};
  CHECK_THROWS_AS(tracked(2, frame, o), Error);
}

TEST_CASE("without objects nothing is measured") {
  const TrackMeasurement m = tracked(12, [](int k) { return cells::picture({}, {}, std::uint64_t(k)); });
  CHECK(quality_of(m.warnings) != Quality::good);
  CHECK(warns(m, "detection"));
}
