#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "study/motion/response_frames.h"

namespace faba {

/// Frames that common_displacement() needs.
inline constexpr std::size_t kLeastShiftFrames = 6;

/// Displacement along one direction that a fraction of the objects has in common.
struct CommonDisplacement {
  double fraction = 0;  ///< of the objects in view, weighted by contrast
  /// Mean displacement between consecutive frames, in the direction in which they move, px of the video.
  double shift_px = 0;
  std::array<double, 2> fraction_ci90{};  ///< from delete-one-block estimates
  std::array<double, 2> shift_ci90{};     ///< likewise, px
  bool clear = false;                     ///< whether the model describes the measured distribution
  double opposite = 0;                    ///< the same fraction in the opposite direction, as a null value
  int gap = 1;                            ///< frames between the compared pictures
  /// Contrast of the objects that do not move and are beside the edge of a drop, relative to that of all
  /// objects in a picture.
  double still_at_edge = 0;
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
/// theirs. Uses up to 64 frames of `part`; the gap between compared pictures is increased up to 0.3 s
/// until the displacement is twice the size of an object, so that objects that move in other directions are
/// distinguished. Empty with fewer than six frames or without any object.
std::optional<CommonDisplacement> common_displacement(const ResponseFrames& frames, const VideoPart& part,
                                                      double direction_deg, double frame_s);

}  // namespace faba
