#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// Whether `path` is a picture sequence: a folder, or a file name with `*`, `?` or a printf number (`%d`,
/// `%04d`) that is not the name of an existing file.
bool is_picture_sequence(const std::filesystem::path& path);

/// The pictures of a sequence in their order. Throws Error(Errc::input) if the folder cannot be read.
std::vector<std::filesystem::path> sequence_files(const std::filesystem::path& sequence);

/// Natural sort order: numbers in names are compared by value, frame_9 before frame_10. True when `a` is
/// before `b`.
bool natural_less(const std::string& a, const std::string& b);

/// Reads a folder of pictures, or a pattern such as `frames/frame_*.tif` or `frames/frame_%04d.tif`, as a
/// video. VideoReader uses it; the public functions have the meaning documented there. In a folder, all files
/// that end in .tif, .tiff, .png, .jpg, .jpeg, .pgm, .ppm, .bmp or .webp are used; with a pattern, all
/// matching files. Hidden files are skipped. The order is natural_less(). Only one picture and the file names
/// are held in memory.
///
/// Times: when the names differ in exactly one number and all its differences are multiples of the smallest
/// difference, a missing picture leaves a gap in time; otherwise the pictures are equally spaced.
class PictureSequence {
 public:
  /// `fps` > 0: pictures per second; 0: unknown, the time of a picture is then its index. Throws
  /// Error(Errc::input, path) when there is no picture or the first one cannot be read.
  PictureSequence(const std::filesystem::path& path, double fps);

  int width() const { return first_.width; }
  int height() const { return first_.height; }
  int bits() const { return bits_; }
  double fps() const { return fps_; }
  std::int64_t pictures() const { return std::int64_t(files_.size()); }

  /// See VideoReader::read. An unreadable picture is skipped and counted. Throws Error(Errc::input, file)
  /// when a picture differs in size or bit depth from the first, or has several pages.
  bool read(GrayF& frame, double& t_s);
  /// Goes to the last picture not after `t_s`: the next read() returns it.
  void seek(double t_s);
  std::int64_t damaged_pictures() const { return damaged_; }
  const std::string& damage() const { return damage_; }

 private:
  void assign_times();

  std::vector<std::filesystem::path> files_;
  std::vector<double> step_index_;  ///< time of each picture in frame intervals
  GrayF first_;
  int bits_ = 8, first_page_count_ = 1;
  double fps_ = 0;
  std::size_t next_ = 0;
  std::int64_t damaged_ = 0;
  std::string damage_;
};

}  // namespace faba
