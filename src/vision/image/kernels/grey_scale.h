#pragma once
#include <string>

#include "vision/image/image.h"

namespace faba {

/// Brings the frames of a video to greys of 0 to 255. Frames of 8 bits stay as they are. Those of more use a
/// part of their scale that depends on the camera, so it is taken from the first frame: its 0.1 % and 99.9 %
/// percentiles become 0 and 255, for all frames alike and without clipping.
class GreyScale {
 public:
  /// `bits` as VideoReader gives it.
  GreyScale(int bits, const GrayF& first_frame);
  void apply(GrayF& frame) const;
  /// What was done in words; empty when nothing was.
  std::string words() const;

 private:
  float black_ = 0, white_ = 255;
};

/// Whole greys of 0 to 255, halves rounded up.
Gray8 rounded(const GrayF& frame);

/// The means of squares of `side` px; what is left over at the right and below is dropped. `side` >= 1 and
/// not larger than the frame.
void shrink(const GrayF& frame, int side, GrayF& out);

}  // namespace faba
