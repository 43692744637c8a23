#pragma once
#include <filesystem>
#include <string>

namespace faba {

/// A figure for a page: up to six frames of a video at equal distances in time, the first and the last among
/// them, beside and below one another with their times under them. Empty when the video cannot be read.
std::string frame_strip(const std::filesystem::path& video);

}  // namespace faba
