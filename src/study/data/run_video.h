#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace faba {

/// The video of a path: the file itself, or the camera video of a run.
struct RunVideo {
  std::filesystem::path file;
  std::optional<double> um_per_px;  ///< of a run
};

/// Whether `path` is a run directory: a folder with a manifest.
bool is_run(const std::filesystem::path& path);
/// Whether a run is complete.
bool is_complete(const std::filesystem::path& run);
/// Whether a run has a camera video.
bool has_camera_video(const std::filesystem::path& run);

/// For a run directory its lossless video, or else its compressed one; any other path is returned unchanged.
/// Throws Error(input, path) for a run without a video, or whose video is a drawing.
RunVideo run_video(const std::filesystem::path& path);

/// A note when options override the frame rate or the scale that a run states: `fps` > 0 in Hz, and
/// `um_per_px`. Empty when `path` is not a run, or the values are those of the run.
std::string override_note(const std::filesystem::path& path, const RunVideo& video, double fps,
                          const std::optional<double>& um_per_px);

}  // namespace faba
