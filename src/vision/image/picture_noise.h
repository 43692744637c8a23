#pragma once
#include "vision/image/image.h"

namespace faba {

/// Standard deviation of the noise of a picture, grey levels: from the median size of a second difference in
/// both directions, which structures larger than 3 px hardly affect (Immerkaer 1996, with the median instead
/// of the mean); at least that of rounding to integers.
double picture_noise(const GrayF& picture);

}  // namespace faba
