#pragma once
#include <filesystem>
#include <optional>
#include <utility>

#include "vision/files/video_reader.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {

/// A video as analyses want it: frames in greys of 0 to 255 (see GreyScale), each averaged over squares of
/// `side` px.
class GreyVideo {
 public:
  /// `side` >= 1, not larger than a frame.
  explicit GreyVideo(VideoReader reader, int side = 1) : reader_(std::move(reader)), side_(side) {}
  /// Throws as VideoReader.
  explicit GreyVideo(const std::filesystem::path& path, double fps = 0, int side = 1)
      : GreyVideo(VideoReader(path, fps), side) {}

  /// As VideoReader::read.
  bool read(GrayF& frame, double& t_s);
  int width() const { return reader_.width() / side_; }
  int height() const { return reader_.height() / side_; }
  int side() const { return side_; }
  const VideoReader& reader() const { return reader_; }
  /// What was done to its greys in words; empty when nothing was, or nothing has been read.
  std::string words() const { return greys_ ? greys_->words() : ""; }

 private:
  VideoReader reader_;
  int side_;
  std::optional<GreyScale> greys_;
  GrayF raw_;
};

}  // namespace faba
