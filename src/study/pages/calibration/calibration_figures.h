#pragma once
#include "study/calibrate/calibration.h"
#include "study/plot/figure.h"

namespace faba {

/// Rank histogram of a parameter with its 99 % band.
Figure rank_figure(const ModelCalibration& m, const ParameterCalibration& p);
/// Estimates and 90 % intervals over the true values.
Figure truth_figure(const ModelCalibration& m, const ParameterCalibration& p);
/// Coverage of the intervals of all parameters of the study over their level.
Figure coverage_figure(const ModelCalibration& m);
/// TARP: coverage of regions of all parameters together over their level, with the 99 % band.
Figure tarp_figure(const ModelCalibration& m);

}  // namespace faba
