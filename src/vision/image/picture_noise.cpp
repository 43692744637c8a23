#include "vision/image/picture_noise.h"

#include <cmath>
#include <vector>

#include "core/statistics.h"

namespace faba {

double picture_noise(const GrayF& p) {
  constexpr double kRounding = 0.2887;  // standard deviation of rounding, 1 / sqrt(12)
  std::vector<float> size;
  for (int r = 1; r + 1 < p.height; ++r)
    for (int c = 1; c + 1 < p.width; ++c) {
      const float edges = p.at(c, r - 1) + p.at(c, r + 1) + p.at(c - 1, r) + p.at(c + 1, r);
      const float corners = p.at(c - 1, r - 1) + p.at(c + 1, r - 1) + p.at(c - 1, r + 1) + p.at(c + 1, r + 1);
      size.push_back(std::fabs(corners - 2 * edges + 4 * p.at(c, r)));
    }
  // The squares of the weights add up to 36. Without pixels the median is not a number.
  return std::fmax(kRounding, kMadToSd * double(median_high(size)) / 6);
}

}  // namespace faba
