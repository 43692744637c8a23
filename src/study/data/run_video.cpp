#include "study/data/run_video.h"

#include <array>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "study/data/run_info.h"

namespace faba {
namespace {

constexpr std::array kVideos = {"video.avi", "video.mp4"};  // the first is lossless

}  // namespace

bool is_run(const std::filesystem::path& path) {
  std::error_code absent;
  return std::filesystem::exists(path / run_files::kManifest, absent);
}

bool is_complete(const std::filesystem::path& run) { return !RunLock::marks(run); }

bool has_camera_video(const std::filesystem::path& run) {
  std::error_code absent;
  for (const char* video : kVideos)
    if (std::filesystem::exists(run / video, absent))
      return read_run_info(run / run_files::kManifest).video_shows == "camera";
  return false;
}

RunVideo run_video(const std::filesystem::path& path) {
  if (!is_run(path)) return {path, {}};
  const RunInfo info = read_run_info(path / run_files::kManifest);
  for (const char* video : kVideos) {
    if (!std::filesystem::exists(path / video)) continue;
    if (info.video_shows != "camera")
      throw Error(Errc::input, path.string(),
                  "its video is a drawing, not a camera video; record the run with --as-seen");
    return {path / video, info.um_per_px};
  }
  throw Error(Errc::input, path.string(), "the run has no video; record it with --as-seen");
}

}  // namespace faba
