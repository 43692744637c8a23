#pragma once
#include <functional>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// Gaussian smoothing with standard deviation `sd_px` > 0. Up to 8 px: sampled kernel truncated at 4 sd;
/// above: four box filters, whose kernel differs by less than 1 % of the peak and whose time does not depend
/// on the width. Border: mirrored at the last pixel. Additions in a fixed order: bit-identical on every
/// machine.
GrayF smoothed(const GrayF& picture, double sd_px);

/// As smoothed(), for wide kernels: above 32 px, squares of pixels are averaged first, and the result is
/// interpolated. The deviation is below 1 % of the contrast of the result; within two standard deviations of
/// the right and lower border, where incomplete squares are dropped, below 2.5 %: the mirrored border is up
/// to sd / 16 px nearer, and the steepest slope of a smoothed edge is 0.4 of its contrast per standard
/// deviation.
GrayF smoothed_broadly(const GrayF& picture, double sd_px);

/// Returns the pixels of a row; called once per row, in order.
using RowSource = std::function<const float*(int row)>;

/// As smoothed(), for a picture that is produced row by row. `out` must be a different picture; `work` is
/// scratch memory. Both keep their memory between calls, which halves the time for pictures of equal size.
void smooth(int width, int height, const RowSource& row, double sd_px, GrayF& out, GrayF& work);

/// Weights of the sampled kernel of smoothed(): index 0 is the centre, the others count twice; their sum is
/// 1. `sd_px` in (0, 8].
std::vector<float> gaussian_weights(double sd_px);

}  // namespace faba
