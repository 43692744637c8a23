#pragma once
#include "vision/image/image.h"

namespace faba {

/// +1 when the spots of a picture are bright, -1 when they are dark, by the curvatures of places that are
/// bent alike in all directions. `fine`: the picture smoothed by a Gaussian of `sd` px; `noise`: of the
/// picture before that, grey.
int spot_polarity(const GrayF& fine, double sd, double noise);

}  // namespace faba
