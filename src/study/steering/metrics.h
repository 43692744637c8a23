#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "study/data/series.h"

namespace faba {

/// How well a closed-loop run was controlled: one number per question (theory F5).
///
/// Terms used below. d_k is `distance_px` of frame k: from the swarm's centroid to the setpoint, the true
/// one in a simulation and the estimated one on a bench. A frame
/// is *targeted* when d_k is a number; the others are left out. t0 and d0 belong to the first targeted frame.
/// A quantity is empty when the run does not define it: no target, a column that is not there, or a condition
/// named with it. Lengths are picture pixels. Times resolve to one frame unless it says "between frames".
struct Metrics {
  std::string source;         ///< of centroid, spread and distance: "true" or "estimated"
  std::size_t frames = 0;     ///< rows of the series
  double duration_s = 0;      ///< from the first to the last frame
  std::size_t setpoints = 0;  ///< different successive setpoints: 0 no target, 1 hold, more on a route

  /// Setpoints that were reached: those of `setpoints` during which some frame had d <= the tolerance of the
  /// reference, or <= the settling band where the reference has none. A setpoint that comes back counts
  /// again. Empty without a target.
  std::optional<double> setpoints_reached;

  /// d0: how far off the swarm was when the first target was given, px.
  std::optional<double> initial_error_px;
  /// d of the last targeted frame, px.
  std::optional<double> final_distance_px;
  /// Half-width of the settling band, px: the larger of 5 % of d0 and 10 px.
  std::optional<double> settling_band_px;
  /// Time from t0 to the last entry into the band, s: to the first frame from which on every targeted frame
  /// has d <= band. 0 when the band was never left; empty when the last targeted frame is outside.
  std::optional<double> settling_time_s;
  /// Time from the first fall of d to 90 % of d0 to its first fall to 10 %, s, d joined by straight lines
  /// between frames. Looks at the first leg only: the frames up to the first change of the setpoint. Empty
  /// when 10 % is not reached there, and when d0 <= 10 px, for then there was no step to answer.
  std::optional<double> rise_time_s;
  /// How far the centroid went past the first setpoint, % of d0: 100 * max(0, max_k s_k - 1), where s_k is
  /// the progress from the first position towards the setpoint, projected on that line and divided by d0.
  /// First leg only. Empty without setpoint columns, when that leg is one frame, and when d0 <= 10 px.
  std::optional<double> overshoot_percent;
  /// Root mean square of d over the last third of the frames: rows from floor(2 n / 3) to the end, px.
  std::optional<double> steady_rms_px;
  /// Integral of d dt by trapezoids between neighbouring targeted frames, px s. Empty with fewer than two of
  /// them.
  std::optional<double> iae_px_s;
  /// Integral of (t - t0) d dt, likewise, px s^2: late errors weigh more.
  std::optional<double> itae_px_s2;

  /// Length of the way the centroid went, the sum of its steps from frame to frame, px. Includes the jitter
  /// of the centroid, so it grows with the frame rate.
  std::optional<double> path_length_px;
  /// Root mean square of the cross-track error e_k, px: distance from the centroid to the polyline that joins
  /// the successive setpoints, its nearest point anywhere. Counted from the first change of the setpoint on,
  /// so that the approach to the first one does not count. Empty with fewer than two setpoints.
  std::optional<double> path_tracking_rms_px;
  /// 95 % quantile of the same e_k, px (linear between order statistics).
  std::optional<double> cross_track_95_px;

  /// Standard deviations of the cells' positions along x and y, and root-mean-square distance from their
  /// centroid, at the last frame, px, as the run recorded them.
  std::optional<double> sigma_x_px, sigma_y_px, rms_radius_px;

  /// Sum over the coils of the integral of I^2 dt, A^2 s; times the coil resistance it is the heat in joule.
  /// A current is held from its frame to the next, so the last frame adds nothing.
  std::optional<double> control_effort_a2_s;
  /// Sum over coils and frames of |I_{k+1} - I_k|, A: how restless the command is.
  std::optional<double> total_variation_a;
  /// Sum over frames of the length of B_{k+1} - B_k at the centroid, uT: the same for runs without coils.
  std::optional<double> total_variation_ut;
  /// Share of the frames whose command was clipped by a limit, 0 to 1.
  std::optional<double> limited_fraction;
};

/// Computes what the columns allow. Needs `t_s`, `distance_px` and the centroid and sigmas of
/// swarm_columns(), and times that increase; else throws Error(Errc::input) with file and line. A series
/// without rows gives frames = 0 and nothing else. `tolerance_px`: of the reference, where it has one.
Metrics control_metrics(const Series& series, std::optional<double> tolerance_px = {});

}  // namespace faba
