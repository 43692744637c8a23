#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Reads and checks a whole scenario. Throws Error(usage) naming file, line, path, reason and the nearest
/// known key.
Scenario read_scenario(Document d, const Parts& parts);

}  // namespace faba
