#pragma once
#include <span>
#include <string>
#include <vector>

#include "control/controller.h"

namespace faba {

/// A controller that steers two swarms, for which the estimator must give several groups.
class TwoSwarmController : public Controller {
 public:
  /// What it cannot do with its field, for the setpoints of the first swarm (m, world); a run prints these
  /// texts at its start.
  virtual std::vector<std::string> notes(std::span<const Vec2> setpoints) const = 0;
};

}  // namespace faba
