#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Reads an event for the current scenario `now` and applies it to `now`. Adds a default estimator and
/// reference if the new controller needs them. On Error(usage) `now` is unchanged.
Event read_event(const Node& n, Scenario& now, const Parts& parts);

/// Applies an event to a scenario.
void change(const Event& e, Scenario& s);

}  // namespace faba
