#pragma once
#include <functional>
#include <string>
#include <vector>

#include "app/sinks/sinks.h"

namespace faba {

/// What is known of a swarm at one moment, m, world frame.
struct SwarmState {
  Vec2 centroid;
  double sigma_x = 0, sigma_y = 0;  ///< standard deviations of the cells' positions
  double visible = 0;               ///< cells in view
  double responding = 0;            ///< cells that feel the field
};

/// One turn as the columns of series.csv see it.
struct SeriesMoment {
  const Tick& tick;
  const SinkContext& run;
  SwarmState truth;      ///< not a number on a bench
  SwarmState estimated;  ///< sigmas are not a number while nothing is seen

  /// The truth where there is one, else the estimate.
  const SwarmState& best() const { return run.truth ? truth : estimated; }
};

/// One column of series.csv.
struct SeriesColumn {
  std::string name;
  std::string unit;  ///< empty for a pure number
  std::string meaning;
  bool simulated_only = false;  ///< it is the simulated truth: a bench has no such column
  std::function<double(const SeriesMoment&)> value;
};

/// Every column of the series.csv of a run with so many coils, in order; what a bench does not have is
/// marked.
std::vector<SeriesColumn> series_columns(std::size_t coils);

/// The same list to be read: K stands for the number of a coil. The column of the currents has no value.
std::vector<SeriesColumn> described_series_columns();

}  // namespace faba
