#pragma once
#include <string>
#include <vector>

#include "study/data/run_info.h"
#include "study/data/series.h"
#include "study/plot/figure.h"
#include "study/steering/metrics.h"

namespace faba {

/// The figures of a run, in the order a reader wants them: distance to the setpoint, path in the picture,
/// dispersion, field, currents, counts of cells. One is left out when its columns are missing or say nothing
/// (no target; counts that never change). Lengths have a second scale in micrometres when the picture scale
/// is known. Throws Error(Errc::input) when a column that every run has is missing (see control_metrics()).
std::vector<Figure> run_figures(const Series& series, const Metrics& metrics, const RunInfo& info);

}  // namespace faba
