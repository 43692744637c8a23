#pragma once
#include <functional>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// The picture smoothed by a Gaussian of standard deviation `sd_px` > 0. Up to 8 px it is the sampled kernel
/// out to 4 sd; wider ones are four running means, whose result differs from it by less than 1 % of a peak
/// and whose time does not grow with the width. Beyond the border the picture counts as mirrored about its
/// last pixel. Plain additions in a fixed order: same bits on every machine.
GrayF smoothed(const GrayF& picture, double sd_px);

/// Gives the pixels of a row; is asked for each once, from the first on.
using RowSource = std::function<const float*(int row)>;

/// The same of a picture that is made row by row, into `out`, which must be another; `work` is scratch. Both
/// keep their memory from call to call, which for pictures of one size after the other is half of the time.
void smooth(int width, int height, const RowSource& row, double sd_px, GrayF& out, GrayF& work);

/// Weights of the sampled kernel that smoothed() uses up to 8 px: index 0 is the middle, the others count
/// twice; they add up to one. `sd_px` in (0, 8].
std::vector<float> gaussian_weights(double sd_px);

}  // namespace faba
