#include "server/videos/open_videos.h"

#include <algorithm>
#include <optional>

#include "server/files/opened_input.h"
#include "study/data/run_video.h"

namespace faba {
namespace {

std::filesystem::file_time_type changed_at(const std::filesystem::path& path) {
  std::error_code absent;
  return std::filesystem::last_write_time(path, absent);
}

std::uintmax_t size_of_video(const std::filesystem::path& path) {
  std::error_code folder;
  const auto size = std::filesystem::file_size(path, folder);
  return folder ? 0 : size;
}

}  // namespace

struct OpenVideos::Video {
  std::filesystem::path path;
  std::filesystem::file_time_type changed;
  std::uintmax_t size = 0;
  std::mutex mutex;  // of `file` and `frames`
  std::optional<OpenedPath> file;
  std::optional<VideoFrames> frames;
  std::size_t bytes = 0;  // protected by the mutex of OpenVideos
};

std::shared_ptr<OpenVideos::Video> OpenVideos::video_of(const std::filesystem::path& path) {
  const auto changed = changed_at(path);
  const auto size = size_of_video(path);
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(videos_.begin(), videos_.end(), [&](const auto& v) { return v->path == path; });
  if (found != videos_.end() && (*found)->changed == changed && (*found)->size == size) {
    videos_.splice(videos_.begin(), videos_, found);
    return videos_.front();
  }
  if (found != videos_.end()) videos_.erase(found);
  auto video = std::make_shared<Video>();
  video->path = path;
  video->changed = changed;
  video->size = size;
  videos_.push_front(video);
  close_oldest();
  return video;
}

// A video in use is closed when its last user has finished.
void OpenVideos::close_oldest() {
  const auto bytes = [this] {
    std::size_t all = 0;
    for (const auto& v : videos_) all += v->bytes;
    return all;
  };
  while (videos_.size() > 1 && (videos_.size() > kMostVideos || bytes() > kMostBytes)) videos_.pop_back();
}

std::size_t OpenVideos::size() const {
  const std::lock_guard lock(mutex_);
  return videos_.size();
}

void OpenVideos::with(const std::filesystem::path& path, const std::function<void(VideoFrames&)>& use,
                      const std::function<RunVideo()>& find) {
  const std::shared_ptr<Video> video = video_of(path);
  const std::lock_guard in_use(video->mutex);
  try {
    if (!video->frames) open(*video, find ? find() : run_video(path));
    use(*video->frames);
  } catch (const Error& e) {
    if (!video->file) throw;
    throw renamed(e, video->file->path().string(), path.string());
  }
}

void OpenVideos::open(Video& video, RunVideo found) {
  video.file.emplace(found.file);
  found.file = video.file->path();
  video.frames.emplace(std::move(found));
  const std::lock_guard lock(mutex_);
  video.bytes = video.frames->bytes();
  close_oldest();
}

}  // namespace faba
