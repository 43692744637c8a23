#include "vision/foreground/spot_polarity.h"

#include <array>
#include <cmath>

#include "core/portable_math.h"

namespace faba {
namespace {

constexpr double kCurvatureSd = 3.5;  // noise sd, minimum curvature of a spot; a false one is harmless
constexpr float kSpotShape =
    0.15F;  // minimum ratio of the curvatures of a spot; 0.25 for a rod of aspect ratio 2

// Principal curvatures of a surface times `sign` (+1: of bright spots), the smaller first.
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
  const float half = 0.5F * (xx - yy), mean = 0.5F * (xx + yy),
              half_difference = std::sqrt(half * half + xy * xy);
  return {mean - half_difference, mean + half_difference};
}

}  // namespace

int spot_polarity(const GrayF& fine, double sd, double noise) {
  // Noise of a second difference of the smoothed picture: its variance is 3 / (16 pi s^6) times the noise
  // variance.
  const auto threshold = float(kCurvatureSd * noise * std::sqrt(3 / (16 * portable::kPi)) / (sd * sd * sd));
  // A line that meets the border appears bent by the mirrored boundary condition.
  const int border = 1 + int(std::ceil(4 * sd));
  std::array<double, 2> evidence{};
  for (int row = border; row + border < fine.height; ++row)
    for (int col = border; col + border < fine.width; ++col)
      for (std::size_t k = 0; k < 2; ++k) {
        const Curvatures c = curvatures(fine, col, row, k == 0 ? -1.0F : 1.0F);
        if (c.small > threshold && c.small > kSpotShape * c.large) evidence[k] += double(c.small);
      }
  return evidence[1] > evidence[0] ? 1 : -1;
}

}  // namespace faba
