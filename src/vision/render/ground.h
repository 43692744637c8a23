#pragma once
#include "vision/image/image.h"

namespace faba {

/// Background model of a video: static background and noise level; also the illumination of a rendered video.
/// Light is a fraction of white; for more than 8 bits, white is the level that GreyScale maps to 255.
struct VideoBackground {
  GrayF light;          ///< background of each pixel
  double noise_sd = 0;  ///< noise of one pixel in one frame, without quantisation noise
};

}  // namespace faba
