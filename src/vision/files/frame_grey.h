#pragma once
#include <cstdint>
#include <string>

#include "vision/image/image.h"

namespace faba {

/// A decoded picture in the decoder's own memory layout, described without the decoder's types.
struct RawFrame {
  const std::uint8_t* const* planes = nullptr;  ///< up to four planes (AVFrame::data)
  const int* strides = nullptr;                 ///< bytes from row to row of each plane; may be negative
  int width = 0, height = 0;                    ///< px
  int pixel_format = -1;                        ///< number of the pixel format (AVPixelFormat)
  int range = 0;                                ///< stated range of luma (AVColorRange; 0: not stated)
  int matrix = 2;                               ///< how colours became luma (AVColorSpace; 2: not stated)
};

/// Bits of the grey scale that to_grey() gives for a pixel format: 8 (0..255) when its channels have up to 8
/// bits, else 16 (0..65535). 0 when the format is not understood (raw Bayer, floating point, frames held by a
/// graphics card).
int grey_bits(int pixel_format);

/// Converts a decoded picture to grey, resizing `out` as needed. Luma is taken as it is when the format has a
/// luma plane; studio range (16..235 for 8 bits), which is what YUV means when it states nothing, is spread
/// so that black is 0 and white 255 (65535), clipped outside. RGB and palettes become grey by grey_of().
/// Samples of other than 8 or 16 bits are scaled to the full scale. Transparency is ignored. The format must
/// be one for which grey_bits() > 0.
void to_grey(const RawFrame& frame, GrayF& out);

/// Converts a decoded picture to colours of 8 bits for the eye, resizing `out` as needed. False when the
/// format cannot be converted.
bool to_colours(const RawFrame& frame, RgbImage& out);

/// The pixel format's name in libav's terms, for messages.
std::string pixel_format_name(int pixel_format);

}  // namespace faba
