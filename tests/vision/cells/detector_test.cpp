#include "vision/cells/detector.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/vision/rendered_cells.h"
#include "vision/cells/spot_fit.h"

using namespace faba;

namespace {

Detector detector_for(const cells::Look& l, const GrayF& frame, double false_alarms = 0.1) {
  DetectorOptions o;
  o.size_px = l.cell_sd_px * kFwhmPerSd;
  o.polarity = l.amplitude < 0 ? Polarity::dark : Polarity::bright;
  o.false_alarms = false_alarms;
  return {spatial_background(frame, 15), o};
}

struct Found {
  int hit = 0, extra = 0;
  double sum = 0, sum2 = 0, reported2 = 0;  // sums over the errors of both axes
};
Found compare(const std::vector<Vec2>& truth, const std::vector<Spot>& spots, double within) {
  Found f;
  std::vector<bool> used(truth.size(), false);
  for (const Spot& s : spots) {
    std::size_t best = truth.size();
    double least = within;
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (const double d = norm(truth[i] - Vec2{s.x_px, s.y_px}); !used[i] && d < least) {
        least = d;
        best = i;
      }
    if (best == truth.size()) {
      ++f.extra;
      continue;
    }
    used[best] = true;
    ++f.hit;
    for (const double e : {s.x_px - truth[best].x, s.y_px - truth[best].y}) {
      f.sum += e;
      f.sum2 += e * e;
    }
    f.reported2 += 2 * s.sd_px * s.sd_px;
  }
  return f;
}

}  // namespace

TEST_CASE("positions are unbiased and have the reported standard error") {
  for (const double noise : {1.0, 4.0, 8.0}) {
    CAPTURE(noise);
    cells::Look l;
    l.noise = noise;
    Found all;
    for (std::uint64_t k = 0; k < 4; ++k) {
      const auto truth = cells::scattered(l, 120, 11, 8, 10 + k);
      const GrayF frame = cells::picture(l, truth, 20 + k);
      const Found f = compare(truth, detector_for(l, frame).find(frame), 2);
      CHECK(f.hit == int(truth.size()));
      CHECK(f.extra <= 2);  // 0.1 per frame expected
      all.sum += f.sum;
      all.sum2 += f.sum2;
      all.reported2 += f.reported2;
      all.hit += f.hit;
    }
    const double n = 2.0 * all.hit, sd = std::sqrt(all.sum2 / n), stated = std::sqrt(all.reported2 / n);
    CHECK(std::fabs(all.sum / n) < 4 * sd / std::sqrt(n));
    // 960 errors: relative error of their sd 2.3 %; the sampled window does not match the spot exactly, and
    // the estimate of the local offset adds noise.
    CHECK(sd < 1.25 * stated);
    CHECK(sd > 0.85 * stated);
  }
}

TEST_CASE("noise gives about the requested number of false detections") {
  cells::Look l;
  l.width = 640;
  l.height = 480;
  l.noise = 6;
  l.uneven = false;
  int found = 0;
  constexpr int kFrames = 6;
  for (std::uint64_t k = 0; k < kFrames; ++k) {
    const GrayF frame = cells::picture(l, {}, 40 + k);
    found += int(detector_for(l, frame, 5).find(frame).size());
  }
  // 30 expected; Poisson: 4 sd are 22. At most a third is lost where the fit does not converge.
  CHECK(found > 8);
  CHECK(found < 52);
}

TEST_CASE("mass, size and shape match those of the spots") {
  for (const double sd : {0.8, 1.27, 3.0, 6.0}) {
    CAPTURE(sd);
    cells::Look l;
    l.cell_sd_px = sd;
    l.noise = 1;
    l.amplitude = 70;
    l.level = 60;
    const auto truth = cells::scattered(l, 20, 14 * sd, 6 * sd, 3);
    const GrayF frame = cells::picture(l, truth, 5);
    DetectorOptions o;
    o.size_px = sd * kFwhmPerSd;
    o.polarity = Polarity::bright;
    const auto spots = Detector(spatial_background(frame, 12 * sd), o).find(frame);
    REQUIRE(spots.size() == truth.size());
    double mass = 0, size = 0;
    for (const Spot& s : spots) {
      mass += s.mass / double(spots.size());
      size += s.size_px / double(spots.size());
    }
    const double pixels = sd * sd;
    // The smoothed background contains a part of the tails of the spot.
    CHECK(mass == doctest::Approx(2 * 3.14159 * pixels * 70).epsilon(0.08));
    CHECK(size == doctest::Approx(sd * kFwhmPerSd).epsilon(0.06));
  }
}

TEST_CASE("the direction of a rod is measured") {
  for (const double angle : {-1.2, 0.3, 1.0}) {
    GrayF frame(120, 90, 100.0F);
    for (int row = 0; row < 90; ++row)
      for (int col = 0; col < 120; ++col) {
        const double dx = col - 60.3, dy = row - 44.6;
        const double a = dx * std::cos(angle) + dy * std::sin(angle),
                     b = -dx * std::sin(angle) + dy * std::cos(angle);
        frame.at(col, row) -= float(50 * std::exp(-0.5 * (a * a / 9 + b * b / 2.25)));
      }
    DetectorOptions o;
    o.size_px = 5;
    const auto spots = Detector({GrayF(120, 90, 100.0F), GrayF(120, 90, 1.0F), 1}, o).find(frame);
    REQUIRE(spots.size() == 1);
    CHECK(spots[0].angle_rad == doctest::Approx(angle).epsilon(0.02));
    CHECK(spots[0].elongation == doctest::Approx(2).epsilon(0.05));
    CHECK(spots[0].x_px == doctest::Approx(60.3).epsilon(0.001));
  }
}

TEST_CASE("two close cells are resolved and do not bias each other") {
  cells::Look l;
  l.noise = 1;
  l.uneven = false;
  for (const double apart : {4.5, 6.0, 8.0}) {
    CAPTURE(apart);
    const std::vector<Vec2> truth{{100.2, 80.4}, {100.2 + apart, 80.4}};
    const GrayF frame = cells::picture(l, truth, 6);
    const Found f = compare(truth, detector_for(l, frame).find(frame), 2);
    CHECK(f.hit == 2);
    CHECK(f.extra == 0);
    CHECK(std::sqrt(f.sum2 / 4) < 0.12);
  }
}

TEST_CASE("no detection outside of the drop and at the border") {
  cells::Look l;
  l.noise = 1;
  l.uneven = false;
  const std::vector<Vec2> truth{{100, 100}, {200, 100}, {0.4, 50}, {319, 200}};
  const GrayF frame = cells::picture(l, truth, 6);
  DetectorOptions o;
  o.size_px = 3;
  o.drop = DropMask{{100, 100}, 40, true, 3};
  CHECK(Detector(spatial_background(frame, 15), o).find(frame).size() == 1);
  o.drop->inside = false;
  const auto outside = Detector(spatial_background(frame, 15), o).find(frame);
  REQUIRE(outside.size() == 1);
  CHECK(outside[0].x_px == doctest::Approx(200).epsilon(0.002));
}

TEST_CASE("the spot size is estimated") {
  Pool pool(2);
  for (const double sd : {1.0, 2.0, 4.0}) {
    CAPTURE(sd);
    cells::Look l;
    l.cell_sd_px = sd;
    l.noise = 3;
    const GrayF frame = cells::picture(l, cells::scattered(l, 40, 9 * sd, 4 * sd, 2), 3);
    const double size = spot_size(frame, spatial_background(frame, 30), Polarity::dark, pool).px;
    // Sizes are tested in steps of 20 %; the maximum of the band-pass response can be off by another 15 %.
    CHECK(size > 0.68 * sd * kFwhmPerSd);
    CHECK(size < 1.38 * sd * kFwhmPerSd);
  }
  const GrayF black(64, 48);
  CHECK(spot_size(black, spatial_background(black, 8), Polarity::dark, pool).px == 0);
}
