#include "study/motion/video_look.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace faba;

namespace {

/// Frames with Gaussian spots that move by 2 px per frame.
VideoLook look(double spot_sd, double noise, double flicker, unsigned seed) {
  std::mt19937 g(seed);
  std::normal_distribution<double> gauss(0, 1);
  VideoLook l;
  for (int k = 0; k < 8; ++k) {
    GrayF p(96, 72);
    const double gain = 1 + flicker * gauss(g);
    for (int r = 0; r < p.height; ++r)
      for (int c = 0; c < p.width; ++c) {
        double dark = 0;
        for (int i = 0; i < 6; ++i) {
          const double dx = c - 12 - 13 * i - 2 * k, dy = r - 12 - 9 * i;
          dark += 60 * std::exp(-(dx * dx + dy * dy) / (2 * spot_sd * spot_sd));
        }
        p.at(c, r) = float(gain * (150 - dark) + noise * gauss(g));
      }
    l.add(std::make_shared<const GrayF>(std::move(p)));
  }
  return l;
}

}  // namespace

TEST_CASE("videos of one kind are comparable; other focus, noise and light are named") {
  const VideoLook reference = look(2.5, 2, 0, 1);
  const auto aspects = [&](const VideoLook& run) {
    std::string all;
    for (const Warning& w : look_warnings(reference, run, 0.3)) all += w.aspect + " ";
    return all;
  };
  CHECK(aspects(look(2.5, 2, 0, 2)) == "");
  CHECK(aspects(look(4, 2, 0, 2)) == "focus ");
  CHECK(aspects(look(2.5, 4, 0, 2)).find("noise ") != std::string::npos);
  CHECK(aspects(look(2.5, 2, 0.05, 2)).find("light ") != std::string::npos);
}

TEST_CASE("flows from a file have no frames and no warnings") {
  VideoLook none;
  none.add(nullptr);
  CHECK(none.empty());
  CHECK(look_warnings(none, none, 0.3).empty());
}

TEST_CASE("light: a uniform change imitates the displacement of an edge by its change over the gradient") {
  LightChange light;
  const auto ramp = [](float level) {
    GrayF p(40, 30);
    for (int r = 0; r < p.height; ++r)
      for (int c = 0; c < p.width; ++c) p.at(c, r) = level + 4 * float(c);
    return std::make_shared<const GrayF>(std::move(p));
  };
  light.add(ramp(50));
  CHECK(light.imitated_px() == 0);
  light.add(ramp(53));  // 3 grey levels at 4 levels per px
  CHECK(light.imitated_px() == doctest::Approx(0.75).epsilon(1e-6));
  light.add(nullptr);
  light.add(std::make_shared<const GrayF>(2, 2));  // too small
  CHECK(light.imitated_px() == doctest::Approx(0.75).epsilon(1e-6));
}
