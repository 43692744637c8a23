#pragma once
#include <functional>

#include "app/scenario/scenario.h"
#include "study/data/series.h"

namespace faba {

/// A whole run on the calling thread that leaves no files: what its series.csv would hold. Throws
/// Error(interrupted) when `stop`, asked after every frame, says so, and what Simulation throws.
Series trial(
    const Scenario& s, std::uint64_t seed, const std::function<bool()>& stop = [] { return false; });

}  // namespace faba
