#pragma once
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// Mean displacement of a square of the picture to the next frame, px, image frame (v down), at its centre.
struct FlowArrow {
  double x = 0, y = 0, u = 0, v = 0;
};

/// The optical flow between two frames for display, by published_flow(): the pictures are first averaged over
/// squares so that no side is longer than 512 px. Squares that hardly move are left out. `bits`: see
/// VideoReader.
std::vector<FlowArrow> flow_arrows(GrayF first, GrayF second, int bits);

}  // namespace faba
