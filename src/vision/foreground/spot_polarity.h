#pragma once
#include "vision/image/image.h"

namespace faba {

/// +1 when the spots of a picture are bright, -1 when they are dark, from the curvatures at positions with
/// similar curvature in all directions. `fine`: the picture smoothed by a Gaussian of `sd` px; `noise`: noise
/// of the unsmoothed picture, grey.
int spot_polarity(const GrayF& fine, double sd, double noise);

}  // namespace faba
