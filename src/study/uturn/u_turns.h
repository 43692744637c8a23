#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "vision/cells/tracker.h"

namespace faba {

/// A complete U-turn of a cell after a field reversal.
struct UTurn {
  std::uint64_t track = 0;
  /// Estimate of 1 / w, s, with the turning rate w = m B / f_r of the cell. Its median over cells is robust;
  /// values of single turns scatter by 1 / sqrt(kappa), and may be negative.
  double time_s = 0;
};

/// The U-turns of a video.
struct UTurnSurvey {
  double frame_s = 0;  ///< time between frames
  std::vector<UTurn> turns;
  std::uint64_t cells = 0;           ///< moving cells in view during a complete window after a reversal
  double half_s = 0;                 ///< median time from a reversal until a cell moves across the field
  double window_s = 0;               ///< evaluated time after a reversal
  double disorder = 0;               ///< <sin^2> / <cos> of the angle to the field while aligned: 1 / kappa
  double noise = 0;                  ///< variance of a velocity component by localisation, over speed squared
  std::optional<double> turn_speed;  ///< speed while moving across the field, over that along it
  std::vector<double> unseen_s;      ///< reversals without turns
};

/// Finds U-turns in tracks and estimates the turning rate of each, with the law of a dipole under rotational
/// diffusion (theory B3.10): after a reversal the mean of c = cos(theta), theta the angle to the new
/// direction of motion, obeys d<c>/dt = w <sin^2> - D_r <c>. With D_r / w = <sin^2> / <c> of the aligned
/// cells
///   1 / w = [integral of (sin^2 - (D_r / w) c) dt] / (change of c),
/// from the velocities between frames, corrected for the localisation error. Only angles are used: no scale
/// is needed. `reversals_s`: times of the reversals, ascending. The axis of the field is that of the motion.
UTurnSurvey find_u_turns(const std::vector<Track>& tracks, const std::vector<double>& reversals_s,
                         double frame_s);

}  // namespace faba
