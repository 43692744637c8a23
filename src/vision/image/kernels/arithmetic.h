#pragma once
#include "vision/image/image.h"

namespace faba {

/// a - b, pixel by pixel, of pictures of the same size.
GrayF difference(const GrayF& a, const GrayF& b);
/// As difference(), into `a`.
void subtract(GrayF& a, const GrayF& b);
/// Multiplies every pixel by a factor.
void multiply(GrayF& a, float by);
/// Multiplies pixel by pixel, pictures of the same size.
void multiply(GrayF& a, const GrayF& by);

}  // namespace faba
