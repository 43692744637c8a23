#pragma once
#include <string>
#include <vector>

#include "app/run/simulation.h"

namespace faba {

/// What is legal but probably not meant, a line each: a setpoint that cannot be reached, cells that nothing
/// moves, a recording larger than the disk. `out` is where the run is recorded.
std::vector<std::string> notes_on(const Scenario& s, const Simulation& simulation,
                                  const std::filesystem::path& out);

}  // namespace faba
