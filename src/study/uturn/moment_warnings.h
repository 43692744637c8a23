#pragma once
#include <vector>

#include "study/uturn/moment_estimate.h"

namespace faba {

/// The violated assumptions of an estimate: too few turns, a frame rate too low for the field, a field too
/// weak for alignment, turns out of the plane, cells that do not turn, a rate that is not proportional to the
/// field, a drag without uncertainty.
std::vector<Warning> moment_warnings(const MomentEstimate& m, const std::optional<CellBody>& cell);

}  // namespace faba
