#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "vision/files/video_reader.h"

namespace faba {

/// A frame of a video with its exact number.
struct IndexedFrame {
  std::int64_t index = 0;  ///< in the file, the first is 0
  double t_s = 0;
  std::shared_ptr<const GrayF> picture;
};

/// Frames of a video by their number, which is that of a table of tracks also if the frame rate varies. The
/// most recent ones stay in memory (64 MB). Thread-safe.
class IndexedFrames {
 public:
  /// `fps` > 0 overrides the frame rate. Throws as VideoReader.
  explicit IndexedFrames(std::filesystem::path video, double fps = 0);

  int width() const { return width_; }
  int height() const { return height_; }
  std::int64_t stated() const { return stated_; }  ///< number of frames according to the file; 0: unknown
  double fps() const { return fps_; }              ///< 0: unknown

  /// Empty if the video has no such frame.
  std::optional<IndexedFrame> find(std::int64_t index);
  /// Throws Error(Errc::input) if the video has no such frame.
  IndexedFrame frame(std::int64_t index);

 private:
  std::optional<IndexedFrame> read(std::int64_t index);
  void go_to(std::int64_t index);

  std::filesystem::path video_;
  double asked_fps_ = 0, fps_ = 0;
  int width_ = 0, height_ = 0;
  std::int64_t stated_ = 0;
  std::mutex mutex_;
  std::deque<IndexedFrame> recent_;
  std::unique_ptr<VideoReader> reader_;
  std::int64_t next_ = 0;  ///< index of the frame that the reader reads next
};

}  // namespace faba
