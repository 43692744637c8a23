#include "vision/foreground/background.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/vision/rendered_cells.h"

using namespace faba;

TEST_CASE("the background of a video is the scene without cells") {
  cells::Look l;
  l.drop = true;
  l.noise = 3;
  BackgroundSampler sampler;
  for (std::uint64_t k = 0; k < 50; ++k)
    sampler.take(cells::picture(l, cells::scattered(l, 60, 4, 4, 50 + k), 100 + k));
  const Background b = sampler.background();
  CHECK(b.frames == 50);
  double worst = 0, sum2 = 0, noise = 0;
  for (int row = 0; row < l.height; ++row)
    for (int col = 0; col < l.width; ++col) {
      const double off = double(b.level.at(col, row)) - cells::ground(l, col, row);
      worst = std::max(worst, std::fabs(off));
      sum2 += off * off / double(b.level.px.size());
      noise += double(b.noise_sd.at(col, row)) / double(b.level.px.size());
    }
  // The median of 50 frames has an sd of 1.25 * 3 / sqrt(50) = 0.53; integer grey steps add 0.29 in
  // quadrature; cells, which cover each pixel in 3 % of the frames, shift it by 0.03 * 1.25 * 3 = 0.11: 0.62
  // in total. The maximum of 77 000 pixels is at 4.5 sd.
  CHECK(std::sqrt(sum2) < 0.66);
  CHECK(worst < 3.2);
  // 1.4826 MAD of 50 values is biased by -2 %; cells and rounding add about the same.
  CHECK(noise == doctest::Approx(3).epsilon(0.06));
}

TEST_CASE("the number of sampled frames is bounded for videos of any length") {
  for (const int frames : {1, 5, 50, 51, 100, 101, 1000}) {
    CAPTURE(frames);
    BackgroundSampler sampler(50);
    for (int k = 0; k < frames; ++k) sampler.take(GrayF(4, 3, float(k)));
    CHECK(int(sampler.kept().size()) <= 50);
    CHECK(int(sampler.kept().size()) >= std::min(frames, 25));
    // The grey values are frame numbers: their median is the middle of the video.
    CHECK(std::fabs(double(sampler.background().level.px[0]) - 0.5 * (frames - 1)) <= 0.04 * frames + 0.5);
  }
  BackgroundSampler small(50, 10 * 12 * sizeof(float));
  for (int k = 0; k < 100; ++k) small.take(GrayF(4, 3));
  CHECK(small.kept().size() <= 10);
}

TEST_CASE("the polarity follows from the differences for all noise levels") {
  for (const double amplitude : {-40.0, 40.0}) {
    cells::Look l;
    l.noise = 5;
    l.amplitude = amplitude;
    l.uneven = false;
    const GrayF p = cells::picture(l, cells::scattered(l, 30, 10, 6, 1), 2);
    std::vector<float> d;
    for (const float v : p.px) d.push_back(v - 150);
    CHECK(polarity_of(d) == (amplitude < 0 ? Polarity::dark : Polarity::bright));
  }
}

TEST_CASE("background of a single frame: smoothed frame, noise of the pixels") {
  cells::Look l;
  l.noise = 4;
  const Background b = spatial_background(cells::picture(l, {}, 3), 12);
  CHECK(double(b.noise_sd.px[0]) == doctest::Approx(std::sqrt(16 + 1.0 / 12)).epsilon(0.02));
  double worst = 0;
  for (int row = 40; row < l.height - 40; ++row)
    for (int col = 40; col < l.width - 40; ++col)
      worst = std::max(worst, std::fabs(double(b.level.at(col, row)) - cells::ground(l, col, row)));
  // Noise of the mean over 4 pi 144 px: 0.09; curvature of the light times 144: 150 * 0.35 * 2 * 144 / 320^2
  // / 2 per axis.
  CHECK(worst < 0.7);
}
