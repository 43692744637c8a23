#pragma once
#include <filesystem>
#include <string>

#include "core/toml.h"

namespace faba {

/// Sets the arena of a scenario to a real drop (theory A13): detects the edge of the drop in a picture, or in
/// the first frame of a video, in the pixel grid of the picture. Swarms without `start` get "visible": they
/// start in the visible part of the drop. Returns a note with the detected circle. Throws Error(input) if
/// there is no usable picture or no edge in it.
std::string fit_to_picture(Document& scenario, const std::filesystem::path& picture_or_video);

}  // namespace faba
