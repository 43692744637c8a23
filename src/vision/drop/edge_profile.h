#pragma once
#include <span>

namespace faba {

/// Shape of the grey profile across an edge.
enum class EdgeShape {
  step,      ///< different grey on the two sides
  ring,      ///< dark or bright line with the same grey on both sides
  step_ring  ///< step and line at the same position
};

/// Result of fit_edge_profile.
struct EdgeProfile {
  EdgeShape shape = EdgeShape::step;
  double position = 0;  ///< half level of the step or centre of the line; unit of the offsets
  double width = 0;     ///< Gaussian sd of the blurred step or of the line; unit of the offsets
  double step = 0;      ///< grey at large minus grey at small offsets; 0 for a ring
  double ring = 0;  ///< grey at the centre of the line minus grey without it; negative: dark; 0 for a step
  double explained = 0;  ///< fraction of the variance about the linear fit that the shape explains, 0..1
};

/// Least-squares fit of a + b t + step * Phi((t - p)/w) + ring * exp(-((t - p)/w)^2/2), Phi the normal
/// distribution, to grey at t = -m, ..., m (an odd number of samples, at least 9). The linear part models
/// uneven light. A pure step or pure line is preferred when it explains nearly as much, because a step with a
/// line beside it is equivalent to a shifted step.
EdgeProfile fit_edge_profile(std::span<const double> grey);

}  // namespace faba
