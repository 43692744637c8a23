#pragma once
#include <cstdint>
#include <functional>

#include "study/tracks/track_measurement.h"

namespace faba {

/// Called between frames with the work done and the total (0: unknown). If it returns false, tracking is
/// cancelled with Error(Errc::interrupted) and no file is written.
using TrackProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Detects and tracks moving spots in a video and measures their motion, in two passes over the frames; the
/// first measures background, size and times. Writes the files of the options when they are complete. Throws
/// Error(Errc::input) for unreadable files, and for a run directory whose video is a drawing.
TrackMeasurement track_video(const TrackOptions& options, const TrackProgress& progress = {});

}  // namespace faba
