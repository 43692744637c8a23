#pragma once
#include <filesystem>
#include <optional>

namespace faba {

/// The video that a path stands for: the file itself, or what the camera saw of a run.
struct RunVideo {
  std::filesystem::path file;
  std::optional<double> um_per_px;  ///< of a run
};

/// Whether `path` is a run directory: a folder with a manifest.
bool is_run(const std::filesystem::path& path);
/// Whether a run was recorded to its end.
bool is_whole(const std::filesystem::path& run);
/// Whether a run holds a video as a camera sees it.
bool has_camera_video(const std::filesystem::path& run);

/// The exact video of a run directory, or else the one for browsers; any other path stands for itself. Throws
/// Error(input, path) for a run whose video is a drawing, or that has none.
RunVideo run_video(const std::filesystem::path& path);

}  // namespace faba
