#pragma once
#include <Eigen/Core>
#include <vector>

#include "control/plant/motion_model.h"

namespace faba {

/// The expected motion of a swarm for a sequence of commands, and its derivatives with respect to them.
struct Horizon {
  std::vector<MeanState> states;  ///< before each move, and after the last one
  /// Derivatives of position, m, and velocity, m/s, of state j with respect to all commands: 4 rows
  /// (x, y, vx, vy) and 2 columns for each move.
  std::vector<Eigen::MatrixXd> by_command;
};

/// The states only.
std::vector<MeanState> expected_states(const SwarmMotion& plant, MeanState from,
                                       const std::vector<Vec2>& commands, double strongest, double time);
/// `commands`: fractions of the field `strongest` (T); each acts for `time` s.
Horizon horizon(const SwarmMotion& plant, MeanState from, const std::vector<Vec2>& commands, double strongest,
                double time);

}  // namespace faba
