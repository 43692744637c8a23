#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/data/run_video.h"
#include "study/tracks/track_options.h"
#include "study/tracks/track_statistics.h"
#include "study/tracks/track_survey.h"

namespace faba {

/// How spots were found in the frames, and how many.
struct TrackDetection {
  double size_px = 0;  ///< full width at half maximum that was looked for
  Polarity polarity = Polarity::dark;
  bool temporal = false;      ///< see TrackSurvey
  int background_frames = 0;  ///< that the background rests on
  double noise_grey = 0;      ///< grey values, median over the picture
  double threshold_snr = 0;   ///< least signal-to-noise
  double spots_per_frame = 0;
  std::int64_t still_spots = 0;            ///< see TrackSurvey
  std::optional<double> mean_place_sd_px;  ///< uncertainty of a place; empty when no spot was found
  std::optional<double> mean_elongation;   ///< empty when no spot was found
  std::optional<DropMask> drop;            ///< that spots were looked for in, where that was asked for
};

/// How spots of successive frames were joined.
struct TrackJoining {
  double reach_px = 0;              ///< farthest step between frames
  Motion motion = Motion::nearest;  ///< nearest or velocity
  int memory_frames = 0;            ///< see TrackerOptions::memory
  int least_points = 0;             ///< see TrackerOptions
  std::uint64_t unsure_tracks = 0;  ///< given up before they had least_points
};

/// How what moves in a video moves.
struct TrackMeasurement {
  std::filesystem::path video;
  std::int64_t frames = 0;
  double duration_s = 0;      ///< from the first frame to the last
  double frame_s = 0;         ///< median time between frames
  bool timed = true;          ///< false: times are counts of frames
  int width = 0, height = 0;  ///< of a frame, px
  std::optional<double> um_per_px;
  TrackDetection detection;
  TrackJoining joining;
  TrackSummary summary;
  std::vector<std::string> notes;
};

/// The walk that a mean-square displacement supports; none with fewer than two lags.
enum class SupportedWalk { none, diffusion, persistent };
SupportedWalk supported_walk(const TrackSummary& summary);

/// Mean over the spans of time of the order in each, weighted by its displacements; NaN where there is none.
double order_at_a_time(const TrackSummary& summary);

/// Looks on while a video is tracked.
class TrackListener {
 public:
  virtual ~TrackListener() = default;
  /// Once per frame, after its spots were joined to the tracks of `tracker`.
  virtual void frame(std::uint64_t index, double t_s, const GrayF& frame, const Tracker& tracker) = 0;
  /// Once per track that ended, and per piece of a long one.
  virtual void track(const Track& track) = 0;
};

/// Detects and tracks what moves in a video: the second pass over its frames, after survey_tracks. `tick` is
/// called with the number of frames done. Throws Error(Errc::input) for what cannot be read.
TrackMeasurement measure_tracks(const TrackOptions& o, const RunVideo& source, const TrackSurvey& survey,
                                TrackListener& listener, const std::function<void(std::int64_t done)>& tick);

}  // namespace faba
