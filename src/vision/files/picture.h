#pragma once
#include <filesystem>

#include "vision/image/image.h"

namespace faba {

/// A picture as read from a file.
struct Picture {
  GrayF grey;     ///< scale of the file: 0 to 2^bits - 1 (255 or 65535); floats are not scaled
  int bits = 8;   ///< bits per channel in the file, or after scaling (see read_picture)
  int pages = 1;  ///< number of pages of a TIFF stack (only the first is read); 1 for other formats
};

/// Reads a picture as grey: TIFF (first page; see TiffStack), PNG, JPEG, PGM, PPM and the other formats of
/// FFmpeg, or the first frame of a video (see VideoReader for the treatment of luma). Samples of 9 to 16 bits
/// are scaled to 0..65535 except in TIFF, samples below 8 bits to 0..255. Transparency, rotation tags and
/// gamma tags are ignored. Throws Error(Errc::input, path) when the file does not exist, is a directory, is
/// empty, is truncated, or is not a picture.
Picture read_picture(const std::filesystem::path& path);

/// Contrast stretch to 8 bits for display: the `low_fraction` quantile of the grey values maps to 0, the
/// `high_fraction` quantile to 255, linear between, clipped outside. When both quantiles are equal (a small
/// bright object on a uniform background) the minimum and the maximum are used; a uniform picture becomes
/// 128. Non-finite pixels become 0. Throws Error(Errc::internal) unless 0 <= low_fraction < high_fraction <=
/// 1.
Gray8 stretched(const GrayF& picture, double low_fraction = 0.01, double high_fraction = 0.99);

/// A grey picture for display: stretched between its 0.1 % and 99.9 % quantiles.
RgbImage displayed(const GrayF& picture);
/// The picture of a file for display, 8 bits: the colours of the file; if it has none (red, green and blue
/// differ by at most 8 everywhere), displayed(). Throws as read_picture().
RgbImage read_displayed(const std::filesystem::path& path);

/// Writes a PNG of 8 bits per channel to a temporary file (`path` + ".tmp") and renames it when complete. An
/// existing file is replaced. Throws Error(Errc::internal, path) when the file cannot be written or the disk
/// is full.
void write_png(const std::filesystem::path& path, const RgbImage& picture);
void write_png(const std::filesystem::path& path, const Gray8& picture);  ///< As above, for grey pictures.

}  // namespace faba
