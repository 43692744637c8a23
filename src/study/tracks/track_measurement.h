#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/data/run_video.h"
#include "study/tracks/track_options.h"
#include "study/tracks/track_result.h"
#include "study/tracks/track_survey.h"

namespace faba {

/// Observer of the tracking of a video.
class TrackListener {
 public:
  virtual ~TrackListener() = default;
  /// Called once per frame, after its spots were linked to the tracks of `tracker`.
  virtual void frame(std::uint64_t index, double t_s, const GrayF& frame, const Tracker& tracker) = 0;
  /// Called once per finished track, and per segment of a long one.
  virtual void track(const Track& track) = 0;
};

/// Detects and tracks the moving objects of a video: the second pass over its frames, after survey_tracks().
/// `tick` is called with the number of frames done. Throws Error(Errc::input) for unreadable videos.
TrackMeasurement measure_tracks(const TrackOptions& o, const RunVideo& source, const TrackSurvey& survey,
                                TrackListener& listener, const std::function<void(std::int64_t done)>& tick);

}  // namespace faba
