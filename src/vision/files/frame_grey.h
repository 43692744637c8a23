#pragma once
#include <cstdint>
#include <string>

#include "vision/image/image.h"

namespace faba {

/// A decoded picture in the decoder's own memory layout, described without types of libav.
struct RawFrame {
  const std::uint8_t* const* planes = nullptr;  ///< up to four planes (AVFrame::data)
  const int* strides = nullptr;                 ///< bytes from row to row of each plane; may be negative
  int width = 0, height = 0;                    ///< px
  int pixel_format = -1;                        ///< pixel format (AVPixelFormat)
  int range = 0;                                ///< range of luma (AVColorRange; 0: unspecified)
  int matrix = 2;                               ///< colour matrix (AVColorSpace; 2: unspecified)
};

/// Bit depth of the grey scale of to_grey() for a pixel format: 8 (0..255) for channels of up to 8 bits, else
/// 16 (0..65535). 0 when the pixel format is not supported (raw Bayer, floating point, frames in the memory
/// of a graphics card).
int grey_bits(int pixel_format);

/// Converts a decoded picture to grey and resizes `out` as needed. Luma is copied when the format has a luma
/// plane; studio range (16..235 for 8 bits), the default of YUV without a range tag, is stretched to 0..255
/// (0..65535) and clipped. RGB and palettes are converted by grey_of(). Samples of other than 8 or 16 bits
/// are scaled to the full scale. Transparency is ignored. Precondition: grey_bits() > 0.
void to_grey(const RawFrame& frame, GrayF& out);

/// Converts a decoded picture to 8-bit RGB for display and resizes `out` as needed. Returns false when the
/// format cannot be converted.
bool to_colours(const RawFrame& frame, RgbImage& out);

/// Name of a pixel format in FFmpeg, for messages.
std::string pixel_format_name(int pixel_format);

}  // namespace faba
