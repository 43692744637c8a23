#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "study/motion/response_frames.h"

namespace faba {

/// Frames that common_displacement() needs.
inline constexpr std::size_t kLeastShiftFrames = 6;

/// A value with its 90 % interval.
struct Measured {
  double value = 0;
  std::array<double, 2> ci90{};
};

/// Parts of a video: after a reversal, and one before it in which the objects may swim the other way.
struct ResponseParts {
  VideoPart after;
  std::optional<VideoPart> before;
};

/// Displacement along one direction that a fraction of the objects has in common. Intervals are from
/// delete-one-block estimates.
struct ShiftedFraction {
  Measured fraction;  ///< of the objects in view, weighted by contrast
  /// Mean displacement between consecutive frames, in the direction in which they move, px of the video.
  Measured shift_px;
  bool clear = false;  ///< whether the model describes the measured distribution
};

/// The common displacement after a reversal, and its opposite before it.
struct CommonDisplacement {
  ShiftedFraction after;
  double opposite = 0;  ///< fraction with the opposite displacement after the reversal, as a null value
  int gap = 1;          ///< frames between the compared pictures
  /// Contrast of the objects that do not move and are beside the edge of a drop, relative to that of all
  /// objects.
  double still_at_edge = 0;
  /// Fraction with the displacements of `after`, backwards in time, before the reversal. Given if `after` is
  /// clear and at most a half, so that most objects may swim in random directions.
  std::optional<Measured> before;
  /// Of both parts, each with the same weight, that before backwards in time. Given with `before`.
  ShiftedFraction both;
};

/// Distribution of the displacements of all objects between pictures, without detection of single objects
/// (after spatio-temporal image correlation; Hebert et al. 2005, Biophys. J. 88:3601; theory A16). The sum of
/// a smoothed picture over the pixels of the objects of another one, against the displacement, is the
/// distribution of the displacements, convolved with the same sum within one picture. Objects that overlap
/// count with their common contrast; the product of both pictures would count it squared. Different objects
/// contribute noise only, also in a dense swarm. Objects without a preferred direction, moving or not,
/// contribute equally in both directions, so that the difference of both directions has only the common
/// displacement. A Gaussian distribution is fitted to it.
///
/// `direction_deg`: image frame; the objects may move in a direction up to 20 degrees off, shifts are along
/// theirs. Uses up to 64 frames of each part; the gap between compared pictures is increased up to 0.3 s
/// until the displacement is twice the size of an object, so that objects that move in other directions are
/// distinguished. Empty with fewer than six frames after the reversal or without any object.
std::optional<CommonDisplacement> common_displacement(const ResponseFrames& frames,
                                                      const ResponseParts& parts, double direction_deg,
                                                      double frame_s);

}  // namespace faba
