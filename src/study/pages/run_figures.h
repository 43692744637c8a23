#pragma once
#include <string>
#include <vector>

#include "study/data/run_info.h"
#include "study/data/series.h"
#include "study/plot/figure.h"
#include "study/steering/metrics.h"

namespace faba {

/// The figures of a run, in the order of the report: distance to the setpoint, path in the picture,
/// dispersion, field, currents, number of cells. A figure is omitted when its columns are missing or without
/// information (no setpoint, constant counts). Lengths have a second axis in micrometres when the picture
/// scale is known. Throws Error(Errc::input) when a mandatory column is missing (see control_metrics()).
std::vector<Figure> run_figures(const Series& series, const Metrics& metrics, const RunInfo& info);

}  // namespace faba
