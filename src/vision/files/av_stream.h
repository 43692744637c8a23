#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vision/image/image.h"

namespace faba {

/// A picture or video file as libavformat and libavcodec read it: what VideoReader uses for all but TIFF, and
/// whose public functions mean the same. The kind of file is told from its content alone, never from its
/// name; only the file itself is opened, whatever addresses a play list may hold.
class AvStream {
 public:
  /// Throws Error(Errc::input, path) when the content is not understood or no frame can be decoded.
  explicit AvStream(const std::filesystem::path& path);
  ~AvStream();
  AvStream(AvStream&&) noexcept;
  AvStream& operator=(AvStream&&) noexcept;

  int width() const;                                ///< px
  int height() const;                               ///< px
  int bits() const;                                 ///< 8 or 16
  double fps() const;                               ///< 0 for a still picture
  std::int64_t frames_stated() const;               ///< 0 when not stated
  bool read(GrayF& frame, double& t_s);             ///< see VideoReader::read
  bool read_colours(RgbImage& frame, double& t_s);  ///< see VideoReader::read_colours
  bool truncated() const;                           ///< see VideoReader::truncated
  std::int64_t damaged_frames() const;              ///< see VideoReader::damaged_frames
  const std::string& damage() const;                ///< see VideoReader::damage

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
