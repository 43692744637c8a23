#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/uturn/moment.h"

namespace faba {

/// Output of `faba moment --json` (docs/formats/cli.md).
nlohmann::ordered_json moment_json(const MomentEstimate& estimate);

}  // namespace faba
