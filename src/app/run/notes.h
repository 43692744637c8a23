#pragma once
#include <string>
#include <vector>

#include "app/run/simulation.h"

namespace faba {

/// A note on a scale that is not known; empty if it is.
std::string scale_note(const ScaleParams& p);

/// Warnings about valid but probably unintended settings, one line each: the notes of its parts
/// (Schema::note), an unreachable setpoint, cells that do not respond, a field too weak to move them, a swarm
/// out of view, a recording larger than the free disk space. `out`: run directory.
std::vector<std::string> scenario_notes(const Scenario& s, const Simulation& simulation,
                                        const std::filesystem::path& out);

}  // namespace faba
