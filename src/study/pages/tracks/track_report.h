#pragma once
#include <cstdint>
#include <functional>

#include "study/tracks/track_measurement.h"

namespace faba {

/// Called between frames with the work done and to do (0: not known). When it gives false the work is broken
/// off with Error(Errc::interrupted), and no file is left behind.
using TrackProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Detects and tracks what moves in a video and measures how it moves: two passes over the frames, the first
/// for background, size and times. Writes the files that the options name, each when it is complete. Throws
/// Error(Errc::input) for what cannot be read, and for a run directory whose video is a drawing.
TrackMeasurement track_video(const TrackOptions& options, const TrackProgress& progress = {});

}  // namespace faba
