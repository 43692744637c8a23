#pragma once
#include <cstddef>
#include <cstdint>

#include "vision/image/image.h"

namespace faba {

/// The three planes of a 4:2:0 picture (memory owned by the caller): luma of even width and height, chroma of
/// half the size.
struct Yuv420Planes {
  std::uint8_t *y = nullptr, *cb = nullptr, *cr = nullptr;
  std::ptrdiff_t y_stride = 0, cb_stride = 0, cr_stride = 0;  ///< bytes per row
};

/// Converts to full-range BT.601 (as in JPEG): Y = 0.299 R + 0.587 G + 0.114 B, Cb = 128 + (B - Y)/1.772, Cr
/// = 128 + (R - Y)/1.402, each rounded to an integer; r = g = b = v gives exactly (v, 128, 128). Chroma is
/// the mean of 2 x 2 pixels (sited at their centre). An odd width or height is made even by repeating the
/// last column or row.
void to_yuv420(const RgbImage& picture, const Yuv420Planes& planes);

}  // namespace faba
