#pragma once
#include "app/scenario/scenario.h"

namespace faba {

/// Reads an event against the scenario as it stands then, and makes the change in it. An estimator and a
/// reference that the new controller cannot do without are added. Throws Error(usage), leaving `now` as it
/// was.
Event read_event(const Node& n, Scenario& now, const Parts& parts);

/// Makes the change of an event in a scenario.
void change(const Event& e, Scenario& s);

}  // namespace faba
