#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Reads and checks a whole scenario. Throws Error(usage) naming file, line, path, reason and the nearest
/// known key.
Scenario read_scenario(Document d, const Parts& parts);

/// The estimator that a scenario has when it names none.
const char* usual_estimator(const Scenario& s);
/// Whether camera, estimator, reference and controller go together; throws Error(usage).
void check_control(const Node& root, const Scenario& s);

}  // namespace faba
