#pragma once
#include "vision/image/image.h"

namespace faba {

/// Means over the inner pixels of two consecutive frames.
struct FrameChange {
  double mean = 0;      ///< of the change of a pixel
  double squared = 0;   ///< of the square of the change
  double slope = 0;     ///< of the squared gradient of the change (central differences)
  double gradient = 0;  ///< of the squared gradient of the second frame
};

/// The frames have the same size, at least 3 x 3 px.
FrameChange frame_change(const GrayF& before, const GrayF& frame);

}  // namespace faba
