#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "vision/files/video_reader.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {

/// A video for analysis: frames in grey values 0 to 255 (see GreyScale), averaged over squares of `side` px
/// (binning).
class GreyVideo {
 public:
  /// `side` >= 1, not larger than a frame.
  explicit GreyVideo(VideoReader reader, int side = 1) : reader_(std::move(reader)), side_(side) {}
  /// Throws as VideoReader.
  explicit GreyVideo(const std::filesystem::path& path, double fps = 0, int side = 1)
      : GreyVideo(VideoReader(path, fps), side) {}

  /// As VideoReader::read, next and picture. `take` is called with the frame as the file has it.
  bool read(GrayF& frame, double& t_s);
  bool next(double& t_s);
  void picture(GrayF& frame, const std::function<void(const GrayF&)>& take = {});
  /// As VideoReader::skip_to. Skips nothing when the grey scale follows from the first frame.
  std::int64_t skip_to(double t_s);
  int width() const { return reader_.width() / side_; }
  int height() const { return reader_.height() / side_; }
  int side() const { return side_; }
  const VideoReader& reader() const { return reader_; }
  /// Description of the applied grey scaling; empty when no scaling was applied or no frame was read yet.
  std::string words() const { return greys_ ? greys_->words() : ""; }

 private:
  VideoReader reader_;
  int side_;
  std::optional<GreyScale> greys_;
  GrayF raw_;
};

}  // namespace faba
