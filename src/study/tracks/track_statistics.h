#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "study/stats/msd_fit.h"
#include "vision/cells/tracker.h"

namespace faba {

/// A value with its standard error from a jackknife over groups of tracks; NaN when undefined.
struct Estimated {
  double value = 0, se = 0;
};

/// A histogram: edges.size() == counts.size() + 1.
struct Histogram {
  std::vector<double> edges;
  std::vector<double> counts;
};

/// Statistics of the motion in a set of tracks. Units of the image: px, s; angles in the image, 0 right, 90
/// degrees down.
struct TrackSummary {
  std::uint64_t tracks = 0, points = 0;
  double mean_points = 0;                ///< per track
  Msd msd;                               ///< relative to the common drift
  Estimated drift_x_px_s, drift_y_px_s;  ///< mean velocity
  /// Smaller over larger variance of the velocities of displacements along their main axes; NaN: too few.
  double velocity_isotropy = 0;
  DiffusionFit diffusion;
  Estimated d_px2_s;
  MsdMisfit diffusion_misfit;
  PersistentFit persistent;
  Estimated speed_rms_px_s, tau_s;  ///< of the persistent random walk
  MsdMisfit persistent_misfit;
  Estimated alpha;
  /// Mean product of two displacements separated by a pause of the same duration, relative to the drift, over
  /// the mean-square displacement; the maximum over durations of 1, 2, 4 or 8 frames. 0 for diffusion with
  /// any localisation error; 1 for straight motion.
  Estimated persistence;
  double persistence_scale_s = 0;
  /// Whether persistence exceeds 0.2 and 3 standard errors at some scale: the persistent random walk is
  /// supported.
  bool persists = false;
  /// Number of frames over which successive positions are correlated, for example by exposure or by a codec
  /// that copies pixels from the previous frame; 0: uncorrelated. Shorter lags are excluded from the
  /// diffusion fit.
  int memory_frames = 0;
  /// Standard deviation of a position per axis, from the offset of the supported fit; 0 when that is
  /// negative.
  double localisation_px = 0;

  int interval_frames = 1;
  double interval_s = 0;  ///< duration of the displacements for the following statistics
  Estimated mean_speed_px_s;
  std::vector<double> speed_quantiles_px_s;  ///< 10, 50, 90 %
  Histogram speeds_px_s;
  std::uint64_t speed_count = 0;
  Estimated turn_deg_s;                      ///< mean rate of turn, absolute
  Estimated signed_turn_deg_s;               ///< mean rate of turn, clockwise positive in the image
  std::vector<double> turn_quantiles_deg_s;  ///< absolute: 10, 50, 90 %
  double turn_noise_deg_s = 0;  ///< mean absolute rate due to the localisation error at the median speed
  std::uint64_t turn_count = 0;
  double order = 0;  ///< order parameter: length of the mean displacement over mean length, 0 to 1
  /// Mean velocity of the displacements in each time bin, px/s, their number, and the order parameter; up to
  /// 512 bins, NaN when empty (for the order: fewer than five).
  std::vector<double> time_s, velocity_x_px_s, velocity_y_px_s, order_in_time, count_in_time;
};

/// Accumulates tracks one by one. Memory: the first 50 000 points, from which the interval and the
/// localisation error are determined, and tables of fixed size.
class TrackStatistics {
 public:
  /// `frame_s`: typical time between frames, s. `interval_frames`: frames between the two positions of a
  /// displacement for speeds and turns; 0: the smallest number for which the displacement is ten times the
  /// localisation error, at most a tenth of the persistence time.
  explicit TrackStatistics(double frame_s, int interval_frames = 0);
  ~TrackStatistics();
  TrackStatistics(TrackStatistics&&) noexcept;
  TrackStatistics& operator=(TrackStatistics&&) noexcept;

  void take(const Track& track);
  TrackSummary summary();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
