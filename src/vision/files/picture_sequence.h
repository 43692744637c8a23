#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// Whether `path` stands for many pictures: a folder, or a name with `*`, `?` or a printf number (`%d`,
/// `%04d`) in its last part that is not itself a file.
bool is_picture_sequence(const std::filesystem::path& path);

/// Numbers inside names count as numbers: frame_9 comes before frame_10. True when `a` comes before `b`.
bool natural_less(const std::string& a, const std::string& b);

/// A folder of pictures, or a pattern such as `frames/frame_*.tif` and `frames/frame_%04d.tif`, read as a
/// video: what VideoReader uses for them, and whose public functions mean the same. Of a folder every file
/// that ends in .tif, .tiff, .png, .jpg, .jpeg, .pgm, .ppm, .bmp or .webp is taken, hidden ones left out;
/// of a pattern every file that fits. Order is natural_less(). The memory is that of one picture and the
/// names.
///
/// Times: when all names differ in one number only, and all differences of it are multiples of the smallest,
/// a missing picture leaves a gap in time; else pictures are taken to be equally spaced.
class PictureSequence {
 public:
  /// `fps` > 0: pictures per second; 0: not known, time is then the count of pictures. Throws
  /// Error(Errc::input, path) when there is no picture or the first cannot be read.
  PictureSequence(const std::filesystem::path& path, double fps);

  int width() const { return first_.width; }
  int height() const { return first_.height; }
  int bits() const { return bits_; }
  double fps() const { return fps_; }
  std::int64_t pictures() const { return std::int64_t(files_.size()); }

  /// See VideoReader::read. A picture that cannot be read is left out and counted. Throws Error(Errc::input)
  /// naming the file when a picture has another size, another number of bits, or several pages.
  bool read(GrayF& frame, double& t_s);
  std::int64_t damaged_pictures() const { return damaged_; }
  const std::string& damage() const { return damage_; }

 private:
  void number();

  std::vector<std::filesystem::path> files_;
  std::vector<double> place_;  ///< in time, in steps from picture to picture
  GrayF first_;
  int bits_ = 8, first_page_count_ = 1;
  double fps_ = 0;
  std::size_t next_ = 0;
  std::int64_t damaged_ = 0;
  std::string damage_;
};

}  // namespace faba
