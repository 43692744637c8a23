#pragma once
#include <filesystem>
#include <memory>

#include "vision/image/image.h"

namespace faba {

/// Reads the pages of a TIFF file one after the other as grey pictures. Memory is that of one page.
///
/// Understood exactly: grey and RGB (interleaved or planar, further channels ignored) of 8 to 16 and 32 bits,
/// signed or not, and 32- or 64-bit floats; strips and tiles; any compression libtiff has. Values keep the
/// file's scale; where white is 0 they are turned round. Palettes, 1 to 4 bits, CMYK and YCbCr arrive as
/// 8-bit colour and become grey. The orientation tag is not applied: pixels come as stored. Pages marked as
/// reduced copies are skipped.
class TiffStack {
 public:
  /// Opens `path` and reads the description of its first page. Throws Error(Errc::input, path) with libtiff's
  /// reason.
  explicit TiffStack(const std::filesystem::path& path);
  ~TiffStack();
  TiffStack(TiffStack&&) noexcept;
  TiffStack& operator=(TiffStack&&) noexcept;

  int width() const;   ///< of the first page, px
  int height() const;  ///< of the first page, px
  /// Bits per sample of the first page: white is 2^bits - 1, except 32 and 64, which may be floats of any
  /// scale.
  int bits() const;
  /// Number of pages, reduced copies included; walks the whole chain of pages, so its time grows with their
  /// number.
  int pages() const;
  /// Frames per second as ImageJ states it in the first page (`fps=` or `finterval=` in seconds); 0 when not
  /// stated.
  double fps() const;

  /// The next page into `page` (resized as needed); false after the last one. A float TIFF may hold NaN: it
  /// is kept. Throws Error(Errc::input, path) when the page is damaged, cut short, or of a kind that is not
  /// understood.
  bool read(GrayF& page);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
