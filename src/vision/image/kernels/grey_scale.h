#pragma once
#include <string>

#include "vision/image/image.h"

namespace faba {

/// Scales the frames of a video to grey values 0 to 255. Frames of 8 bits are not changed. For more bits, the
/// used part of the scale depends on the camera, so the 0.1 % and 99.9 % percentiles of the first frame are
/// mapped to 0 and 255, for all frames and without clipping.
class GreyScale {
 public:
  /// `bits`: bit depth from VideoReader.
  GreyScale(int bits, const GrayF& first_frame);
  void apply(GrayF& frame) const;
  /// Description of the scaling for notes; empty when the frames are not changed.
  std::string words() const;

 private:
  float black_ = 0, white_ = 255;
};

/// Rounds to integers and clips to 0..255; halves are rounded up.
Gray8 rounded(const GrayF& frame);

/// Averages squares of `side` px (binning); incomplete squares at the right and bottom are dropped. 1 <=
/// `side` <= size of the frame.
void shrink(const GrayF& frame, int side, GrayF& out);

}  // namespace faba
