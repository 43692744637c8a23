#pragma once
#include <optional>
#include <vector>

#include "study/quality/quality.h"

namespace faba {

/// The warning of a run with a nominal scale, um per px; none if the scale is known.
std::vector<Warning> scale_warnings(const std::optional<double>& nominal_um_per_px);

}  // namespace faba
