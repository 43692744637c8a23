#pragma once
#include "vision/image/image.h"

namespace faba {

/// What stays the same in a video, and how noisy it is: the light for a rendered one. Shares of white, which
/// of frames of more than 8 bits is what GreyScale makes white.
struct VideoGround {
  GrayF light;          ///< of each pixel where nothing is
  double noise_sd = 0;  ///< of one pixel of one frame, quantisation taken out
};

}  // namespace faba
