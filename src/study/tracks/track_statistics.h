#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "study/stats/msd_fit.h"
#include "vision/cells/tracker.h"

namespace faba {

/// A number with its standard error from a jackknife over groups of tracks; NaN when there is none.
struct Estimated {
  double value = 0, se = 0;
};

/// A histogram: edges.size() == counts.size() + 1.
struct Histogram {
  std::vector<double> edges;
  std::vector<double> counts;
};

/// What a set of tracks says about how its cells move. Picture units: px, s; angles in the picture, 0 right,
/// 90 degrees down.
struct TrackSummary {
  std::uint64_t tracks = 0, points = 0;
  double mean_points = 0;                ///< per track
  Msd msd;                               ///< about the common drift
  Estimated drift_x_px_s, drift_y_px_s;  ///< mean velocity of all
  DiffusionFit diffusion;
  Estimated d_px2_s;
  PersistentFit persistent;
  Estimated speed_rms_px_s, tau_s;  ///< of the persistent walk
  Estimated alpha;
  /// Mean product of two displacements with a pause of the same length between them, about the drift, over
  /// the mean-square displacement; over 1, 2, 4 or 8 frames, where it is largest. 0 for diffusion, whatever
  /// the localisation error; 1 for straight motion.
  Estimated persistence;
  double persistence_scale_s = 0;
  bool persists =
      false;  ///< at some scale over 0.2 and over 3 standard errors: the walk is the persistent one
  /// Frames over which successive places hang together more than chance, as by exposure or a codec that
  /// carries pixels over from the frame before; 0: not at all. Lags up to it are left out of the diffusion
  /// fit.
  int memory_frames = 0;
  double localisation_px =
      0;  ///< sd of an axis, from the offset of the fit that is supported; 0 when negative

  int interval_frames = 1;
  double interval_s = 0;  ///< over which displacements are taken for what follows
  Estimated mean_speed_px_s;
  std::vector<double> speed_quantiles_px_s;  ///< 10, 50, 90 %
  Histogram speeds_px_s;
  std::uint64_t speed_count = 0;
  Estimated turn_deg_s;                      ///< mean of the size of the heading's change over time
  Estimated signed_turn_deg_s;               ///< mean of the change itself, positive clockwise as seen
  std::vector<double> turn_quantiles_deg_s;  ///< of the size: 10, 50, 90 %
  double turn_noise_deg_s = 0;  ///< mean size that the localisation error alone gives at the median speed
  std::uint64_t turn_count = 0;
  double order = 0;  ///< length of the mean displacement over the mean length, 0 none, 1 all in one direction
  /// Mean velocity of all displacements in each span of time, px/s, their number, and the order as above; up
  /// to 512 spans, NaN where there was none (for the order: fewer than five).
  std::vector<double> time_s, velocity_x_px_s, velocity_y_px_s, order_in_time, count_in_time;
};

/// Takes tracks one by one. Memory: the tracks until there are 50 000 points, from which the interval and the
/// localisation error are taken, and tables of fixed size from then on.
class TrackStatistics {
 public:
  /// `frame_s`: usual time between frames, s. `interval_frames`: frames between the two places of a
  /// displacement for speeds and turns; 0: the fewest after which the displacement is ten times the
  /// localisation error, at most a tenth of the time in which directions are forgotten.
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
