#include "study/data/run_video.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <vector>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "study/data/run_info.h"
#include "vision/files/video_libraries.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr std::array kVideos = {"video.avi", "video.mp4"};  // the first is lossless

}  // namespace

void expect_videos() { load_video_libraries(); }

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

RunVideo video_or_drawing(const std::filesystem::path& path) {
  if (!is_run(path)) return {path, scale_of_file(path)};
  const RunInfo info = read_run_info(path / run_files::kManifest);
  for (const char* video : kVideos)
    if (std::filesystem::exists(path / video))
      return {path / video, {info.um_per_px, info.um_per_px_source, ""}, info.video_shows != "camera"};
  throw Error(Errc::input, path.string(), "the run has no video; record it with --as-seen");
}

RunVideo run_video(const std::filesystem::path& path) {
  RunVideo video = video_or_drawing(path);
  if (video.drawing)
    throw Error(Errc::input, path.string(),
                "its video is a drawing, not a camera video; record the run with --as-seen");
  return video;
}

std::string override_note(const std::filesystem::path& path, const RunVideo& video, double fps,
                          const std::optional<double>& um_per_px) {
  const bool run = is_run(path);
  std::vector<std::string> stated, used, options;
  const auto compare = [&](double of_run, double given, const char* unit, const char* option) {
    if (!(of_run > 0) || std::fabs(given / of_run - 1) < 1e-6) return;
    stated.push_back(fmt::format("{:.6g} {}", of_run, unit));
    used.push_back(fmt::format("{:.6g} {}", given, unit));
    options.emplace_back(option);
  };
  if (fps > 0 && run) compare(VideoReader(video.file).fps(), fps, "Hz", "--fps");
  if (um_per_px && video.scale.um_per_px) compare(*video.scale.um_per_px, *um_per_px, "um/px", "--um-per-px");
  if (stated.empty()) return "";
  return fmt::format("the {} states {}; {} {} used ({})", run ? "run" : "file", fmt::join(stated, " and "),
                     fmt::join(used, " and "), used.size() == 1 ? "is" : "are", fmt::join(options, ", "));
}

void check_has_frames(const std::filesystem::path& file) { (void)VideoReader(file); }

}  // namespace faba
