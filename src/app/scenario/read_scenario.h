#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Reads and checks a complete scenario. Throws Error(usage) with file, line, path, reason and the most
/// similar known key.
Scenario read_scenario(Document d, const Parts& parts);

}  // namespace faba
