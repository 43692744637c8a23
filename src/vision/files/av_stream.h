#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vision/image/image.h"

namespace faba {

struct AvDecoder;

/// Decoder of picture and video files by libavformat and libavcodec. VideoReader uses it for every format
/// except TIFF; the public functions have the meaning documented there. The format is detected from the
/// content, not from the file name. Only the file itself is opened; addresses in a play list are not
/// followed.
class AvStream {
 public:
  /// `threads` decode, with the same result for any number. Throws Error(Errc::input, path) when the format
  /// is not supported or no frame can be decoded.
  explicit AvStream(const std::filesystem::path& path, unsigned threads = 1);
  ~AvStream();
  AvStream(AvStream&&) noexcept;
  AvStream& operator=(AvStream&&) noexcept;

  int width() const;                                ///< px
  int height() const;                               ///< px
  int bits() const;                                 ///< 8 or 16
  double fps() const;                               ///< 0 for a still image
  std::int64_t frames_in_header() const;            ///< 0 when not stated
  std::int64_t skip_to(double t_s);                 ///< see VideoReader::skip_to
  bool seek(double t_s);                            ///< see VideoReader::seek
  bool next(double& t_s);                           ///< see VideoReader::next
  void picture(GrayF& frame);                       ///< see VideoReader::picture
  bool read(GrayF& frame, double& t_s);             ///< see VideoReader::read
  bool read_colours(RgbImage& frame, double& t_s);  ///< see VideoReader::read_colours
  bool truncated() const;                           ///< see VideoReader::truncated
  std::int64_t damaged_frames() const;              ///< see VideoReader::damaged_frames
  const std::string& damage() const;                ///< see VideoReader::damage

 private:
  void read_by_one_thread();
  std::unique_ptr<AvDecoder> decoder_;
};

}  // namespace faba
