#pragma once
#include "vision/image/image.h"

namespace faba {

/// Whether no value is infinite or NaN.
bool all_finite(const GrayF& frame);

}  // namespace faba
