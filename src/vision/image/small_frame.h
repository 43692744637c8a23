#pragma once
#include "vision/image/image.h"

namespace faba {

/// A reduced picture of a video for a report.
struct SmallFrame {
  RgbImage picture;
  double t_s = 0;
};

constexpr int kSmallFrameWidth = 320;  // px, maximum

/// The picture averaged over squares of n x n px, with the smallest n for which it is at most
/// kSmallFrameWidth wide; incomplete squares at the right and lower edge are omitted.
RgbImage small_picture(const RgbImage& picture);
RgbImage small_picture(const Gray8& picture);

}  // namespace faba
