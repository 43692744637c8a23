#pragma once
#include <span>

namespace faba {

/// What the grey across an edge looks like.
enum class EdgeShape {
  step,      ///< one grey on one side, another on the other
  ring,      ///< a dark or bright line, the same grey on both sides
  step_ring  ///< both at one place
};

/// Where an edge is along a line across it.
struct EdgeProfile {
  EdgeShape shape = EdgeShape::step;
  double position = 0;  ///< middle of the step (half level, steepest) or of the line; unit of the offsets
  double width = 0;     ///< Gaussian sd of the blurred step or of the line; unit of the offsets
  double step = 0;      ///< grey at large minus grey at small offsets; 0 for a ring
  double ring = 0;      ///< grey at the line's middle minus grey without it; negative: dark; 0 for a step
  double explained =
      0;  ///< share of the profile's variance, after its best straight line, that the shape explains, 0..1
};

/// Least-squares fit of a + b t + step * Phi((t - p)/w) + ring * exp(-((t - p)/w)^2/2), Phi the
/// normal distribution, to grey at t = -m, ..., m (an odd number of samples, at least 9). The linear part is
/// uneven light. A step alone, or a line alone, is preferred when it explains nearly as much, because a step
/// with a line beside it can stand for a step moved sideways.
EdgeProfile fit_edge_profile(std::span<const double> grey);

}  // namespace faba
