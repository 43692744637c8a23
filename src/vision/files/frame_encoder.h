#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "vision/files/video_format.h"
#include "vision/image/image.h"

struct AVCodecContext;

namespace faba {

/// Encodes pictures of one size into one packet of bytes per picture, without delay. Single-threaded. The
/// bytes do not depend on the processor: the same pictures since construction or the last restart() give the
/// same bytes.
class FrameEncoder {
 public:
  enum class Kind {
    png_colour,  ///< each packet is a complete PNG file, 8-bit RGB
    png_grey,    ///< each packet is a complete PNG file, 8-bit grey
    png_grey16,  ///< each packet is a complete PNG file, 16-bit grey
    pgm,         ///< each packet is a complete PGM file, 8-bit grey
    ppm,         ///< each packet is a complete PPM file, 8-bit RGB
    tiff,        ///< each packet is a complete TIFF file, 8-bit grey
    h264,  ///< each packet is one picture of an H.264 byte stream (Annex B), headers repeated at key frames
    h264_grey,  ///< as h264, from grey pictures
  };

  /// `width`, `height`: px, 1 to 16384. `rate` is used by H.264 only, which has at least one key frame per
  /// second. `where` is the file named in errors. Throws Error(Errc::internal) when the size is out of range
  /// or this FFmpeg does not have the encoder.
  FrameEncoder(Kind kind, int width, int height, FrameRate rate = {}, std::string where = {});
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// Encodes one picture; the result is valid until the next call. h264: full-range BT.601 4:2:0, so r = g =
  /// b = v has luma v; an odd width or height is made even by repeating the last column or row. Throws
  /// Error(Errc::internal) when the size or the pixel type does not match the encoder.
  std::span<const std::uint8_t> encode(const RgbImage& picture);
  std::span<const std::uint8_t> encode(const Gray8& picture);                 ///< For png_grey and h264_grey.
  std::span<const std::uint8_t> encode(const Image<std::uint16_t>& picture);  ///< For png_grey16.

  /// Discards the encoder state: the next picture is encoded as a key frame, as by a new encoder.
  void restart();

  /// The parameters of the encoded stream, for its container.
  const AVCodecContext& codec() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
