#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/optics/optics_setup.h"

namespace faba {

/// The plan of an experiment as reported by `faba optics --json` and the lab: `setup` (all values), the
/// figures of OpticsPlan, lengths of the sample in um, and `verdicts[]` = {measurement, title, quality,
/// evidence, warnings[]}.
nlohmann::ordered_json optics_json(const OpticsSetup& setup);

}  // namespace faba
