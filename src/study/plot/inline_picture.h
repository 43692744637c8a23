#pragma once
#include <string>
#include <string_view>

#include "vision/image/image.h"

namespace faba {

/// A picture as markup that holds it: an <img> element with a PNG inside, as wide as its place. `words` stand
/// for it where it cannot be seen.
std::string inline_picture(const RgbImage& picture, std::string_view words);

}  // namespace faba
