#pragma once
#include <filesystem>

#include "vision/image/image.h"

namespace faba {

/// A picture as read from a file.
struct Picture {
  GrayF grey;     ///< in the file's own scale: 0 to 255 or 0 to 65535 (2^bits - 1); floats as they are
  int bits = 8;   ///< bits per channel in the file, or the scale it was brought to (see read_picture)
  int pages = 1;  ///< pages of a TIFF stack, of which the first was read; 1 for everything else
};

/// Reads a picture as grey: TIFF (first page; see TiffStack), PNG, JPEG, PGM, PPM and all else FFmpeg knows,
/// or the first frame of a video (see VideoReader, which says how luma is taken). Samples of 9 to 16 bits
/// other than TIFF are brought to 0..65535, those below 8 bits to 0..255. Transparency, rotation tags and
/// gamma tags are ignored. Throws Error(Errc::input, path) when the file is missing, a directory, empty, cut
/// short, or no picture.
Picture read_picture(const std::filesystem::path& path);

/// `picture` brought to 8 bits for the eye: the grey value below which `low_fraction` of the pixels lie
/// becomes 0, the one below which `high_fraction` lie becomes 255, linear between, clipped outside. When the
/// two are equal (a small bright thing on an even ground) the smallest and largest value are taken; an even
/// picture becomes 128. Pixels that are not finite become 0. 0 <= low_fraction < high_fraction <= 1, else
/// Error(Errc::internal).
Gray8 stretched(const GrayF& picture, double low_fraction = 0.01, double high_fraction = 0.99);

/// Writes a PNG of 8 bits per channel, under a temporary name (`path` + ".tmp") that is renamed when
/// complete. An existing file is replaced. Throws Error(Errc::internal, path) when the place cannot be
/// written or the disk is full.
void write_png(const std::filesystem::path& path, const RgbImage& picture);
void write_png(const std::filesystem::path& path, const Gray8& picture);  ///< The same for grey pictures.

}  // namespace faba
