#include "vision/foreground/spot_polarity.h"

#include <array>
#include <cmath>

#include "core/portable_math.h"

namespace faba {
namespace {

constexpr double kCurvatureSd =
    3.5;  // of the noise of a curvature, from which on a spot is one: a false one is harmless
constexpr float kSpotShape =
    0.15F;  // smaller over larger curvature of a spot; a rod twice as long as wide has 0.25

// The two curvatures of a surface, in the direction of `sign` (+1: of bright spots), the smaller first.
struct Curvatures {
  float small, large;
};
Curvatures curvatures(const GrayF& g, int col, int row, float sign) {
  const float v = g.at(col, row), l = g.at(col - 1, row), r = g.at(col + 1, row), u = g.at(col, row - 1),
              d = g.at(col, row + 1);
  const float xx = sign * (2 * v - l - r), yy = sign * (2 * v - u - d);
  const float xy =
      sign * 0.25F *
      (g.at(col + 1, row - 1) + g.at(col - 1, row + 1) - g.at(col + 1, row + 1) - g.at(col - 1, row - 1));
  const float half = 0.5F * (xx - yy), mean = 0.5F * (xx + yy), apart = std::sqrt(half * half + xy * xy);
  return {mean - apart, mean + apart};
}

}  // namespace

int spot_polarity(const GrayF& fine, double sd, double noise) {
  // Noise of a second difference of the smoothed picture; its variance is 3 / (16 pi s^6) of the noise's.
  const auto least = float(kCurvatureSd * noise * std::sqrt(3 / (16 * portable::kPi)) / (sd * sd * sd));
  // Mirrored at the border, a line that meets it looks bent.
  const int border = 1 + int(std::ceil(4 * sd));
  std::array<double, 2> evidence{};
  for (int row = border; row + border < fine.height; ++row)
    for (int col = border; col + border < fine.width; ++col)
      for (std::size_t k = 0; k < 2; ++k) {
        const Curvatures c = curvatures(fine, col, row, k == 0 ? -1.0F : 1.0F);
        if (c.small > least && c.small > kSpotShape * c.large) evidence[k] += double(c.small);
      }
  return evidence[1] > evidence[0] ? 1 : -1;
}

}  // namespace faba
