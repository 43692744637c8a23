#pragma once
#include <vector>

#include "core/vec.h"

namespace faba {

/// A limit that can change a plan. The numbers are bits of the message to the page (web/protocol.md).
enum class PlanLimit { output, current, slew, heat, view, drop, obstacle };

/// What a controller that predicts intends to do. It follows from the state of the controller and is not part
/// of it.
struct Plan {
  /// Predicted positions of the swarm, m, world frame: the first at the time at which the command acts, the
  /// last at the horizon.
  std::vector<Vec2> path;
  double step = 0;                ///< s, between two positions
  std::vector<PlanLimit> active;  ///< limits without which the plan would be another; each at most once
};

}  // namespace faba
