#pragma once
#include <filesystem>
#include <functional>

#include "vision/render/ground.h"

namespace faba {

/// How the ground of a video is found.
struct VideoGroundOptions {
  double fps = 0;  ///< as VideoReader takes it
  int side = 1;    ///< frames are averaged over squares of so many px
  /// Share of the frames in which a pixel is darker than its light, noise taken out: a half is the median;
  /// more where dark things cover it most of the time, less for bright ones.
  double share = 0.5;
  double from_s = 0, to_s = 1e300;     ///< frames before and after are left out
  std::function<void()> tick = [] {};  ///< called after each frame
};

/// Reads the video once. The light is from at most 48 frames, evenly spread; the noise is the 68.3 %
/// quantile of the changes from one frame to the next over sqrt(2), so that what moves does not count as long
/// as it is a small part of the picture. 0 for a single frame. Throws Error(input, path) as VideoReader does,
/// and when no frame is left.
VideoGround read_video_ground(const std::filesystem::path& video, const VideoGroundOptions& options = {});

}  // namespace faba
