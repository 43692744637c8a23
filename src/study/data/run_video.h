#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "study/data/video_scale.h"

namespace faba {

/// The video of a path: the file itself, or the camera video of a run.
struct RunVideo {
  std::filesystem::path file;
  VideoScale scale;      ///< of a run, or in the metadata of the file
  bool drawing = false;  ///< the video of a run shows a drawing of the swarm, not what the camera sees
};

/// Starts to load the libraries for videos in another thread: for a verb that reads a video a little later.
void expect_videos();

/// Whether `path` is a run directory: a folder with a manifest.
bool is_run(const std::filesystem::path& path);
/// Whether a run is complete.
bool is_complete(const std::filesystem::path& run);
/// Whether a run has a camera video.
bool has_camera_video(const std::filesystem::path& run);

/// For a run directory its lossless video, or else its compressed one; any other path is returned unchanged,
/// with the scale in its metadata.
/// Throws Error(input, path) for a run without a video, or whose video is a drawing.
RunVideo run_video(const std::filesystem::path& path);
/// The same, also for a run whose video is a drawing.
RunVideo video_or_drawing(const std::filesystem::path& path);

/// Throws Error(input) with the reason unless the file is a video, a picture sequence or a picture that can
/// be read.
void check_has_frames(const std::filesystem::path& file);

/// A note when options override the frame rate or the scale that a run or the metadata of a file states:
/// `fps` > 0 in Hz, and `um_per_px`. Empty when nothing is stated, or the values are the same.
std::string override_note(const std::filesystem::path& path, const RunVideo& video, double fps,
                          const std::optional<double>& um_per_px);

}  // namespace faba
