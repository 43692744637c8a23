#pragma once
#include <functional>
#include <string>
#include <vector>

#include "app/sinks/sinks.h"

namespace faba {

/// State of a swarm at one time, m, world frame.
struct SwarmState {
  Vec2 centroid;
  double sigma_x = 0, sigma_y = 0;  ///< standard deviations of the cell positions
  double visible = 0;               ///< number of cells in view
  double responding = 0;            ///< number of cells that respond to the field
};

/// Data of one control cycle, for the columns of series.csv.
struct SeriesCycle {
  const Tick& tick;
  const SinkContext& run;
  SwarmState truth;      ///< not used on a bench
  SwarmState estimated;  ///< sigmas are NaN while no swarm is detected

  /// The true state if available, otherwise the estimate.
  const SwarmState& best() const { return run.truth ? truth : estimated; }
};

/// One column of series.csv.
struct SeriesColumn {
  std::string name;
  std::string unit;  ///< empty for a pure number
  std::string meaning;
  bool simulated_only = false;  ///< true state, which runs on a bench do not have
  std::function<double(const SeriesCycle&)> value;
};

/// All columns of series.csv of a run with this number of coils, in order.
std::vector<SeriesColumn> series_columns(std::size_t coils);

/// The same list for documentation, with K for the number of a coil. The column of the currents has no value.
std::vector<SeriesColumn> described_series_columns();

}  // namespace faba
