#pragma once
#include <string>
#include <string_view>

#include "vision/image/image.h"

namespace faba {

/// The picture as a PNG in a data URL.
std::string picture_url(const RgbImage& picture);

/// <img> element with an embedded PNG, as wide as its container. `alternative`: alternative text.
std::string inline_picture(const RgbImage& picture, std::string_view alternative);

}  // namespace faba
