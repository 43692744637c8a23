#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "study/data/video_frames.h"

namespace faba {

/// The videos that pages display. A video stays open until others need its memory, so that the next frame is
/// found quickly. Thread-safe: requests for one video wait for each other.
class OpenVideos {
 public:
  /// Calls `use` with the video, opened again if the file has changed. `find` returns its file, without
  /// links; default: run_video(). Throws as VideoFrames and OpenedPath.
  void with(const std::filesystem::path& path, const std::function<void(VideoFrames&)>& use,
            const std::function<RunVideo()>& find = {});

  std::size_t size() const;  ///< number of open videos
  static constexpr std::size_t kMostVideos = 8;
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;  ///< estimated, of the decoded frames

 private:
  struct Video;
  std::shared_ptr<Video> video_of(const std::filesystem::path& path);
  void open(Video& video, RunVideo found);
  void close_oldest();

  mutable std::mutex mutex_;
  std::list<std::shared_ptr<Video>> videos_;  ///< the one that was used last is the first
};

}  // namespace faba
