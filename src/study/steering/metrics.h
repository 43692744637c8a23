#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "study/data/series.h"

namespace faba {

/// Metrics of a closed-loop run (theory F5).
///
/// Definitions: d_k is `distance_px` of frame k, from the centroid of the swarm to the setpoint; the true
/// centroid in a simulation, the estimated one on a bench. A frame is *targeted* when d_k is finite; other
/// frames are ignored. t0 and d0 belong to the first targeted frame. A quantity is empty when it is undefined
/// for the run: no target, a missing column, or a condition given with its definition. Lengths are in image
/// pixels. Times have a resolution of one frame unless "between frames" is specified.
struct Metrics {
  std::string source;         ///< of centroid, dispersion and distance: "true" or "estimated"
  std::size_t frames = 0;     ///< rows of the series
  double duration_s = 0;      ///< from the first to the last frame
  std::size_t setpoints = 0;  ///< distinct successive setpoints: 0 no target, 1 hold, more on a route
  /// Setpoints of the reference, including those that were not reached before the end of the run.
  std::size_t given_setpoints = 0;

  /// Number of reached setpoints: those with a frame with d <= the tolerance of the reference, or <= the
  /// settling band when the reference has no tolerance. A repeated setpoint counts again. Empty without a
  /// target.
  std::optional<double> setpoints_reached;

  /// d0: distance at the first targeted frame, px.
  std::optional<double> initial_error_px;
  /// d of the last targeted frame, px.
  std::optional<double> final_distance_px;
  /// Half-width of the settling band, px: the larger of 5 % of d0 and 10 px.
  std::optional<double> settling_band_px;
  /// Time from t0 to the last entry into the band, s: to the first frame from which all targeted frames have
  /// d <= band. 0 when the band is never left; empty when the swarm is not settled: the last targeted frame
  /// is outside, or the run ended before the last setpoint of its route, where d leaves the band again.
  std::optional<double> settling_time_s;
  /// Time from the first fall of d to 90 % of d0 to its first fall to 10 %, s, interpolated linearly between
  /// frames, in the first leg: the frames up to the first change of the setpoint. Empty when 10 % is not
  /// reached there, and when d0 <= 10 px (no step).
  std::optional<double> rise_time_s;
  /// Overshoot of the centroid beyond the first setpoint, % of d0: 100 * max(0, max_k s_k - 1), where s_k is
  /// the progress from the first position towards the setpoint, projected on the line to it and divided by
  /// its length. First leg only. Empty without setpoint columns, when that leg has one frame, and when d0 <=
  /// 10 px.
  std::optional<double> overshoot_percent;
  /// Root mean square of d over the last third of the frames: rows from floor(2 n / 3) to the end, px.
  std::optional<double> steady_rms_px;
  /// Largest d in the same frames, px.
  std::optional<double> steady_max_px;
  /// Integral of d dt by the trapezoidal rule between consecutive targeted frames, px s. Empty with fewer
  /// than two of them.
  std::optional<double> iae_px_s;
  /// Integral of (t - t0) d dt, computed in the same way, px s^2: late errors have more weight.
  std::optional<double> itae_px_s2;

  /// Path length of the centroid, the sum of its steps between frames, px. Includes the jitter of the
  /// centroid, and therefore increases with the frame rate.
  std::optional<double> path_length_px;
  /// Root mean square of the cross-track error e_k, px: distance from the centroid to the nearest point of
  /// the polyline of successive setpoints. Evaluated from the first change of the setpoint, so that the
  /// approach to the first setpoint is excluded. Empty with fewer than two setpoints.
  std::optional<double> cross_track_rms_px;
  /// 95 % quantile of the same e_k, px (linear between order statistics).
  std::optional<double> cross_track_95_px;

  /// Standard deviations of the cell positions along x and y, and their root-mean-square distance from the
  /// centroid, at the last frame, px, as recorded.
  std::optional<double> sigma_x_px, sigma_y_px, rms_radius_px;
  std::optional<double> initial_rms_radius_px;  ///< the last of these at the first frame
  /// Number of cells in view at the last frame, and the largest number in a frame, as recorded.
  std::optional<double> visible_at_end, most_visible;

  /// Sum over the coils of the integral of I^2 dt, A^2 s; multiplied by the coil resistance it is the heat in
  /// joule. A current is constant from its frame to the next; the last frame is not counted.
  std::optional<double> control_effort_a2_s;
  /// Sum over coils and frames of |I_{k+1} - I_k|, A.
  std::optional<double> total_variation_a;
  /// Sum over frames of |B_{k+1} - B_k| at the centroid, uT; also for runs without coils.
  std::optional<double> total_variation_ut;
  /// Fraction of the frames whose command was clipped by a limit, 0 to 1.
  std::optional<double> limited_fraction;

  /// Only for trials of a study: mean heat of all coils over the run, W; fraction of the frames in which the
  /// true mean of the swarm is in a region of the study that it must not enter, and mean fraction of the
  /// cells in it, 0 to 1.
  std::optional<double> coil_heat_w, keep_out_fraction, keep_out_cells;

  static constexpr std::size_t kMaxRouteSetpoints = 50;  ///< more are a moving setpoint, not a route
  /// Whether the run ended before the last setpoint of its route.
  bool route_unfinished() const {
    return setpoints > 0 && setpoints < given_setpoints && given_setpoints <= kMaxRouteSetpoints;
  }
};

/// Computes the metrics that the columns permit. Needs `t_s`, `distance_px`, the centroid and sigmas of
/// swarm_columns(), and increasing times; else throws Error(Errc::input) with file and line. For a series
/// without rows frames is 0 and all metrics are empty. `tolerance_px`: of the reference, if it has one;
/// `given_setpoints`: the number of its setpoints, if known.
Metrics control_metrics(const Series& series, std::optional<double> tolerance_px = {},
                        std::size_t given_setpoints = 0);

}  // namespace faba
