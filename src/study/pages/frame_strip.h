#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "vision/image/small_frame.h"

namespace faba {

/// Figure for a page: up to six frames of a video at equal time intervals, including the first and the last,
/// with their times below. Empty when the video cannot be read.
std::string frame_strip(const std::filesystem::path& video);
/// The same of the given frames.
std::string frame_strip(const std::vector<SmallFrame>& frames);

}  // namespace faba
