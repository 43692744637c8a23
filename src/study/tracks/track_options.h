#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "vision/cells/tracker.h"
#include "vision/foreground/background.h"

namespace faba {

/// How the background of a video is found.
enum class BackgroundKind {
  automatic,  ///< the median, unless more than half of the spots would vanish with it because they stand
              ///< still
  median,     ///< temporal median: removes all that never moves, as the edge of a drop
  spatial     ///< smoothing of each frame: keeps what stands still
};

/// What `faba track` is asked to do. What is not given is found from the video.
struct TrackOptions {
  std::filesystem::path video;  ///< anything VideoReader reads, or a run directory
  double fps = 0;               ///< > 0: in place of what the video states
  std::optional<double> um_per_px;
  std::vector<std::filesystem::path> out;  ///< tables of the tracks, .csv or .h5
  std::filesystem::path swarm;             ///< table of the swarm's place and spread in each frame, .csv
  std::filesystem::path overlay;           ///< video with the tracks drawn in, .mp4 or .avi
  std::filesystem::path report;            ///< page with the figures, .html
  std::filesystem::path picture;           ///< all tracks on the first frame, .png
  std::filesystem::path figures;           ///< folder for the figures, one .svg each
  double size_px = 0;                      ///< full width at half maximum of a spot; 0: found
  Polarity polarity = Polarity::automatic;
  BackgroundKind background = BackgroundKind::automatic;
  double threshold_sd = 0;   ///< least signal-to-noise; 0: one false spot in ten frames by noise
  bool inside_drop = false;  ///< find the edge of the drop in the first frame and look inside it only
  TrackerOptions tracker;
  int interval_frames = 0;  ///< of displacements for speeds and turns; 0: found
};

}  // namespace faba
