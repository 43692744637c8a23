#pragma once
#include <algorithm>
#include <cstddef>

#include "vision/image/image.h"

namespace faba {

/// A rectangle of pixels of a picture: its first column and row, and its size.
struct PixelRegion {
  int col = 0, row = 0, width = 0, height = 0;  ///< px
};

/// The part of a picture inside of a region, which must lie in the picture.
template <class T>
Image<T> cropped(const Image<T>& picture, const PixelRegion& region) {
  Image<T> out(region.width, region.height);
  for (int row = 0; row < region.height; ++row) {
    const T* from =
        &picture.px[std::size_t(region.row + row) * std::size_t(picture.width) + std::size_t(region.col)];
    std::copy_n(from, region.width, &out.px[std::size_t(row) * std::size_t(region.width)]);
  }
  return out;
}

}  // namespace faba
