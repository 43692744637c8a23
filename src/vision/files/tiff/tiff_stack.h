#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "vision/files/tiff/tiff_description.h"
#include "vision/image/image.h"

namespace faba {

/// Reads the pages of a TIFF file in order as grey pictures. Only one page is held in memory.
///
/// Read directly, as floats: grey and RGB (interleaved or planar; further channels are ignored) of 8 to 16
/// and 32 bits, signed or unsigned, and 32- or 64-bit floats; strips and tiles; all compressions of libtiff.
/// Values keep the scale of the file; MINISWHITE pictures are inverted. Palettes, 1 to 4 bits, CMYK and YCbCr
/// are converted to 8-bit colour and then to grey. The orientation tag is ignored: pixels are in storage
/// order. Reduced-resolution pages are skipped.
class TiffStack {
 public:
  /// Opens `path` and reads the tags of its first page. Throws Error(Errc::input, path) with the message of
  /// libtiff.
  explicit TiffStack(const std::filesystem::path& path);
  ~TiffStack();
  TiffStack(TiffStack&&) noexcept;
  TiffStack& operator=(TiffStack&&) noexcept;

  int width() const;   ///< of the first page, px
  int height() const;  ///< of the first page, px
  /// Bits per sample of the first page: white is 2^bits - 1, except for 32 and 64 bits, which may be floats.
  int bits() const;
  /// Number of pages, including reduced-resolution pages. Reads all directories of the file: O(pages).
  int pages() const;
  /// Pixel size and frame rate that the first page states.
  const PictureMetadata& metadata() const;
  double fps() const { return metadata().fps; }  ///< Frames per second; 0 when unknown.

  /// Reads the next page into `page` (resized as needed); returns false after the last one. NaN values of a
  /// float TIFF are kept. Throws Error(Errc::input, path) when the page is damaged, truncated or not
  /// supported.
  bool read(GrayF& page);
  /// Goes to a page, counted from 0 without reduced-resolution pages, or to the last one if there are fewer:
  /// the next read() returns it. Returns its number. Throws as read().
  std::int64_t seek(std::int64_t page);
  /// The next page in 8-bit colours, for display, without reading it; empty for grey pages.
  void read_colours(RgbImage& page);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
