#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/table.h"

namespace faba {

/// What was recorded once per camera frame: named columns of equal length, one row per frame, in the order
/// written. The unit is the end of a column's name (`_px` picture pixels with y down, `_s` seconds, `_ut`
/// microtesla in the world frame with y up, `_a` ampere). NaN stands for "nothing there", for instance a
/// setpoint when there is no target.
///
/// The columns of a run's `series.csv` are described in app/sinks/series_columns.h; `true_...` is what a
/// simulation knows, `estimated_...` what the estimator believed.
using Series = Table;

/// Reads a series.csv. A last line without its line end, as a power cut leaves it, is left out. Columns of
/// runs of version 0.1 are given today's names; where `commands.csv` beside it says that the run was on a
/// bench, what was called `centroid` is an estimate.
Series read_series(const std::filesystem::path& path);

/// Where the swarm was in each row, px: the truth where the run has it, else the estimate.
struct SwarmColumns {
  std::string source;  ///< "true" or "estimated"
  std::span<const double> x, y;
  std::span<const double> sigma_x, sigma_y;
  std::vector<double> rms_radius;  ///< root of the sum of both variances
};
/// Views into `series`. Throws Error(input) naming file and column when it has neither.
SwarmColumns swarm_columns(const Series& series);

}  // namespace faba
