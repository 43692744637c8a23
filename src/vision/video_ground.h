#pragma once
#include <filesystem>
#include <functional>

#include "vision/image.h"

namespace faba {

/// What stays the same in a video, and how noisy it is: the light for a rendered one. Shares of white, which
/// of frames of more than 8 bits is what GreyScale makes white.
struct VideoGround {
  GrayF light;          ///< median over time of each pixel
  double noise_sd = 0;  ///< of one pixel of one frame, quantisation taken out
};

/// Reads the whole video once. The median is over at most 48 frames, evenly spread; the noise is the 68.3 %
/// quantile of the changes from one frame to the next over sqrt(2), so that what moves does not count as long
/// as it is a small part of the picture. 0 for a single frame. Frames are averaged over squares of `side` px;
/// `tick` is called after each. Throws Error(input, path) as VideoReader does.
VideoGround read_video_ground(
    const std::filesystem::path& video, int side = 1, const std::function<void()>& tick = [] {});

}  // namespace faba
