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

/// Sets the scale of a scenario to that of a real picture, unless the scenario gives `um_per_px` or `file` in
/// [scale]: the pixel size in the metadata of the picture (see PictureMetadata), otherwise a nominal scale,
/// with which the results are stated in pixels only. Returns a note on a pixel size that differs from the
/// scenario's, or that is not valid; otherwise empty.
std::string take_scale(Document& scenario, const std::filesystem::path& picture_or_video);

}  // namespace faba
