#pragma once
#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "control/plant/linear_design.h"

namespace faba {

/// A pole of the sampled loop, and the continuous motion that it stands for.
struct LoopMode {
  std::complex<double> pole;
  double time_constant = 0;  ///< s
  double frequency = 0;      ///< Hz; 0: no oscillation
  double damping = 1;        ///< ratio
};

/// The linear design of the controller of a scenario, with the loop that it makes.
struct LoopDesign {
  LqrDesign design;
  int delay = 0;  ///< frames
  Margins margins;
  std::vector<LoopMode> modes;
  std::vector<std::string> notes;  ///< of the scenario: the design is linear and has no limits
};
/// Throws Error(usage) if the controller has no design, no field moves the swarm, or its pictures are too
/// old.
LoopDesign loop_design(const Scenario& s);

}  // namespace faba
