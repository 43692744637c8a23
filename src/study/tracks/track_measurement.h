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

/// Parameters and results of the detection of spots.
struct TrackDetection {
  double size_px = 0;  ///< full width at half maximum of a spot
  Polarity polarity = Polarity::dark;
  bool temporal = false;      ///< see TrackSurvey
  int background_frames = 0;  ///< number of frames used for the background
  double noise_grey = 0;      ///< grey levels, median over the image
  double threshold_snr = 0;   ///< smallest signal-to-noise ratio
  double spots_per_frame = 0;
  std::int64_t stationary_spots = 0;       ///< see TrackSurvey
  std::optional<double> mean_place_sd_px;  ///< standard deviation of a position; empty without spots
  std::optional<double> mean_elongation;   ///< empty without spots
  std::optional<DropMask> drop;            ///< searched region, when restricted to the drop
};

/// Parameters and results of the linking of spots to tracks.
struct TrackJoining {
  double search_radius_px = 0;         ///< largest displacement between frames
  Motion motion = Motion::nearest;     ///< nearest or velocity
  int max_gap_frames = 0;              ///< see TrackerOptions::max_gap_frames
  int min_points = 0;                  ///< see TrackerOptions
  std::uint64_t discarded_tracks = 0;  ///< discarded because they had fewer than min_points
};

/// Result of tracking a video.
struct TrackMeasurement {
  std::filesystem::path video;
  std::int64_t frames = 0;
  double duration_s = 0;      ///< from the first frame to the last
  double frame_s = 0;         ///< median time between frames
  bool timed = true;          ///< false: times are frame counts
  int width = 0, height = 0;  ///< of the frames, px
  std::optional<double> um_per_px;
  TrackDetection detection;
  TrackJoining joining;
  TrackSummary summary;
  std::vector<std::string> notes;
};

/// The model of motion that a mean-square displacement supports; none with fewer than two lags.
enum class SupportedWalk { none, diffusion, persistent };
SupportedWalk supported_walk(const TrackSummary& summary);

/// Mean over the time bins of the order parameter in each, weighted by its displacements; NaN when there are
/// no bins.
double mean_order(const TrackSummary& summary);

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
