#pragma once
#include <functional>

#include "app/scenario/scenario.h"
#include "study/data/series.h"

namespace faba {

/// Runs a complete trial on the calling thread without output files and returns the contents of its
/// series.csv. `stop` is called after every frame; throws Error(interrupted) when it returns true, and the
/// errors of Simulation.
Series trial(
    const Scenario& s, std::uint64_t seed, const std::function<bool()>& stop = [] { return false; });

}  // namespace faba
