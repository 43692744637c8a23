#pragma once
#include <string>
#include <vector>

#include "app/run/simulation.h"
#include "app/scenario/scenario.h"

namespace faba {

/// Adds what a run cannot do, or does not need, as far as it concerns steering: setpoints, polarities, zeros
/// of the field, and what the controller itself states.
void add_steering_notes(const Scenario& s, const Simulation& simulation, std::vector<std::string>& notes);

}  // namespace faba
