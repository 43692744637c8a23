#pragma once
#include <filesystem>

#include "core/toml.h"

namespace faba {

/// Fits a scenario to a real drop (theory A13): finds the drop's edge in a picture, or in the first
/// frame of a video, and makes the scenario's arena that drop, in the picture's own pixel grid. Swarms
/// without a start of their own begin in the visible part of the drop. Throws Error(input) when there is no
/// usable picture or no edge in it.
void fit_to_picture(Document& scenario, const std::filesystem::path& picture_or_video);

}  // namespace faba
