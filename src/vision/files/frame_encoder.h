#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "vision/files/video_format.h"
#include "vision/image/image.h"

namespace faba {

/// Turns pictures of one size into coded bytes, one piece per picture and none held back. One thread, and the
/// bytes do not depend on the processor: the same pictures since the start or the last restart() give the
/// same bytes.
class FrameEncoder {
 public:
  enum class Kind {
    png_colour,  ///< every piece is a complete PNG file, 8-bit RGB
    png_grey,    ///< every piece is a complete PNG file, 8-bit grey
    png_grey16,  ///< every piece is a complete PNG file, 16-bit grey
    pgm,         ///< every piece is a complete PGM file, 8-bit grey
    ppm,         ///< every piece is a complete PPM file, 8-bit RGB
    tiff,        ///< every piece is a complete TIFF file, 8-bit grey
    h264,  ///< every piece is one picture of an H.264 byte stream (Annex B), headers repeated at key frames
    h264_grey,  ///< the same from grey pictures
  };

  /// `width`, `height` in px (1 to 16384); `rate` matters for H.264 only, where a key frame comes at least
  /// once a second. Throws Error(Errc::internal) when the size is out of range or this FFmpeg lacks the
  /// encoder.
  FrameEncoder(Kind kind, int width, int height, FrameRate rate = {}, std::string where = {});
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// The coded picture, valid until the next call. h264: full-range BT.601 4:2:0, so that r = g = b = v has
  /// luma v; an odd width or height is made even by repeating the last column or row. Throws
  /// Error(Errc::internal) on another size than promised, or on pixels that the kind is not made for.
  std::span<const std::uint8_t> encode(const RgbImage& picture);
  std::span<const std::uint8_t> encode(const Gray8& picture);                 ///< For png_grey and h264_grey.
  std::span<const std::uint8_t> encode(const Image<std::uint16_t>& picture);  ///< For png_grey16.

  /// Forgets all earlier pictures: what follows is coded as by a new encoder, beginning with a key frame.
  void restart();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
