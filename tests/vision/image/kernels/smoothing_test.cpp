#include "vision/image/kernels/smoothing.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace faba;

namespace {

// Uneven light with dark objects.
GrayF picture(int width, int height) {
  GrayF p(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const bool object = (c / 25 + r / 31) % 5 == 0;
      p.at(c, r) = 120 + 0.2F * float(c) - 30 * std::cos(float(r) / 60) - (object ? 40.0F : 0.0F);
    }
  return p;
}

}  // namespace

TEST_CASE("broad smoothing: deviates from smoothing by less than 1 % of the contrast, 2.5 % at the border") {
  const GrayF p = picture(403, 302);  // not multiples of the squares
  for (const double sd : {32.0, 40.0, 85.0}) {
    const GrayF exact = smoothed(p, sd), broad = smoothed_broadly(p, sd);
    const auto [low, high] = std::minmax_element(exact.px.begin(), exact.px.end());
    float inside = 0, border = 0;
    for (int r = 0; r < p.height; ++r)
      for (int c = 0; c < p.width; ++c) {
        const bool near = c > p.width - 2 * sd || r > p.height - 2 * sd;
        float& largest = near ? border : inside;
        largest = std::max(largest, std::fabs(exact.at(c, r) - broad.at(c, r)));
      }
    CAPTURE(sd);
    CHECK(inside < 0.01F * (*high - *low));
    CHECK(border < 0.025F * (*high - *low));
  }
}

TEST_CASE("broad smoothing: narrow kernels and small pictures are smoothed exactly") {
  CHECK(smoothed_broadly(picture(60, 50), 20).px == smoothed(picture(60, 50), 20).px);
  CHECK(smoothed_broadly(picture(1, 1), 100).px == picture(1, 1).px);
}
