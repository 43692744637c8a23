#pragma once
#include "vision/image/image.h"

namespace faba {

/// Applies the mean over squares of 2 `half` + 1 pixels `times` times: first all means along the rows, then
/// those along the columns; the time does not depend on `half`. Sums are in double, so that rounding errors
/// do not accumulate. Border: mirrored at the last pixel.
void box_filter(GrayF& picture, int half, int times);

}  // namespace faba
