#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "vision/image/small_frame.h"

namespace faba {

/// Up to six frames of a video at equal time intervals, including the first and the last. Empty when the
/// video cannot be read.
std::vector<SmallFrame> strip_frames(const std::filesystem::path& video);
/// Figure for a page: the frames, with their times below. Empty without frames.
std::string frame_strip(const std::vector<SmallFrame>& frames);

}  // namespace faba
