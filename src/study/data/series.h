#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/table.h"

namespace faba {

/// Data recorded once per camera frame: named columns of equal length, one row per frame. The suffix of a
/// column's name is the unit (`_px` image pixels with y down, `_s` seconds, `_ut` microtesla in the world
/// frame with y up, `_a` ampere). NaN is a missing value, for instance a setpoint when there is no target.
///
/// The columns of a run's `series.csv` are described in app/sinks/series_columns.h; `true_...` is the ground
/// truth of a simulation, `estimated_...` the output of the estimator.
using Series = Table;

/// Reads a series.csv. An incomplete last line, as after a power failure, is dropped. Columns of runs of
/// version 0.1 are renamed to the present names; with `commands.csv` beside the file the run was on a bench,
/// and `sigma_..` are estimates.
Series read_series(const std::filesystem::path& path);

/// Position and dispersion of the swarm in each row, px: ground truth where available, else the estimate.
struct SwarmColumns {
  std::string source;  ///< "true" or "estimated"
  std::span<const double> x, y;
  std::span<const double> sigma_x, sigma_y;
  std::vector<double> rms_radius;  ///< root of the sum of the variances along x and y
};
/// Views into `series`. Throws Error(input) naming file and column when it has neither.
SwarmColumns swarm_columns(const Series& series);

}  // namespace faba
