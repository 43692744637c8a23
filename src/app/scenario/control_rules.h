#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Whether camera, estimator, reference and controller go together; throws Error(usage) at `root` (a scenario
/// or an event) naming what would do.
void check_control(const Node& root, const Scenario& s, const Parts& parts);

}  // namespace faba
