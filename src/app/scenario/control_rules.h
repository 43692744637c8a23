#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Checks that camera, estimator, reference and controller are compatible. Throws Error(usage) at `root` (a
/// scenario or an event) with suitable parts.
void check_control(const Node& root, const Scenario& s, const Parts& parts);

}  // namespace faba
