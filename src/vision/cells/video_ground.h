#pragma once
#include <filesystem>
#include <functional>

#include "vision/render/ground.h"

namespace faba {

/// Options of read_video_background.
struct VideoBackgroundOptions {
  double fps = 0;  ///< frame rate override, see VideoReader
  int side = 1;    ///< frames are averaged over squares of `side` px
  /// Temporal quantile of each pixel that is used as background, corrected for noise: 0.5 is the median;
  /// larger if dark objects cover the pixel most of the time, smaller for bright objects.
  double quantile = 0.5;
  double from_s = 0, to_s = 1e300;     ///< time range of the frames used
  unsigned threads = 1;                ///< 0: all; they do not change the result
  std::function<void()> tick = [] {};  ///< called after each frame
};

/// Background model of a video, read once. The background is computed from at most 48 frames, uniformly
/// spaced; the noise is the 68.3 % quantile of the absolute difference between consecutive frames over
/// sqrt(2), which is insensitive to moving objects that cover a small part of the picture; 0 for a single
/// frame. Throws Error(input, path) as VideoReader, and when there are no frames in the time range.
VideoBackground read_video_background(const std::filesystem::path& video,
                                      const VideoBackgroundOptions& options = {});

}  // namespace faba
