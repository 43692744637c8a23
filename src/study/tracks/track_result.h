#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/quality/quality.h"
#include "study/tracks/populations.h"
#include "study/tracks/stage_drift.h"
#include "study/tracks/track_scores.h"
#include "study/tracks/track_statistics.h"
#include "vision/cells/detector.h"
#include "vision/cells/tracker.h"
#include "vision/image/coding_traces.h"
#include "vision/image/region.h"

namespace faba {

/// Parameters and results of the detection of spots.
struct TrackDetection {
  double size_px = 0;                 ///< full width at half maximum of a spot
  bool size_given = false;            ///< else it was estimated
  std::optional<TwoSizes> two_sizes;  ///< see SpotSize
  Polarity polarity = Polarity::dark;
  bool temporal = false;         ///< see TrackSurvey
  int background_frames = 0;     ///< number of frames used for the background
  double noise_grey = 0;         ///< grey levels, median over the image
  double threshold_snr = 0;      ///< smallest signal-to-noise ratio
  bool threshold_given = false;  ///< else it follows from the noise
  double spots_per_frame = 0;
  std::int64_t stationary_spots = 0;       ///< see TrackSurvey
  std::optional<double> mean_place_sd_px;  ///< standard deviation of a position; empty without spots
  std::optional<double> mean_elongation;   ///< empty without spots
  CodingTraces coding;                     ///< of the video
  std::optional<DropMask> drop;            ///< when the search is restricted to the drop
  std::optional<PixelRegion> region;       ///< when the search is restricted to it
  double searched_px2 = 0;                 ///< area in which spots are searched
  std::optional<double> median_snr;        ///< of the spots; empty without spots
};

/// Parameters and results of the linking of spots to tracks.
struct TrackJoining {
  double search_radius_px = 0;         ///< largest displacement between frames
  Motion motion = Motion::nearest;     ///< nearest or velocity
  int max_gap_frames = 0;              ///< see TrackerOptions::max_gap_frames
  int min_points = 0;                  ///< see TrackerOptions
  std::uint64_t discarded_tracks = 0;  ///< discarded because they had fewer than min_points
  bool crowded = false;                ///< see Tracker::crowded()
  std::optional<double> reproduced;    ///< fraction of the links, see LinkCheck; empty: too few
};

/// Result of tracking a video.
struct TrackMeasurement {
  std::filesystem::path video;
  std::int64_t frames = 0;
  double duration_s = 0;            ///< from the first frame to the last
  double frame_s = 0;               ///< median time between frames
  bool timed = true;                ///< false: times are frame counts
  int width = 0, height = 0;        ///< of the frames, px
  std::optional<double> um_per_px;  ///< empty: not known
  std::string um_per_px_source;     ///< see VideoScale
  TrackDetection detection;
  TrackJoining joining;
  TrackSummary summary;
  std::vector<SpeedPopulation> populations;  ///< see PopulationSurvey
  StageDrift stage;
  std::vector<TrackScore> scores;  ///< of all tracks
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

/// The model of motion that a mean-square displacement supports; none with fewer than two lags.
enum class SupportedWalk { none, diffusion, persistent };
SupportedWalk supported_walk(const TrackSummary& summary);
/// The misfit of that model.
const MsdMisfit& misfit_of(const TrackSummary& summary);

/// Whether one mean describes the speeds: there are not several populations.
inline bool one_population(const TrackMeasurement& m) { return m.populations.size() < 2; }

/// Mean over the time bins of the order parameter in each, weighted by its displacements; NaN when there are
/// no bins.
double mean_order(const TrackSummary& summary);

}  // namespace faba
