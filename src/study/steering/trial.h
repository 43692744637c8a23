#pragma once
#include <functional>
#include <vector>

#include "app/scenario/scenario.h"
#include "study/data/series.h"
#include "study/steering/metrics.h"

namespace faba {

/// Runs a complete trial on the calling thread without output files and returns the contents of its
/// series.csv. `stop` is called after every frame; throws Error(interrupted) when it returns true, and the
/// errors of Simulation.
Series trial(
    const Scenario& s, std::uint64_t seed, const std::function<bool()>& stop = [] { return false; });

/// A trial with its metrics, also those that need more than series.csv: the heat of the coils, and the cells
/// in regions that they should not enter.
struct MeasuredTrial {
  Series series;
  Metrics metrics;
};
struct TrialOptions {
  std::size_t setpoints = 0;                        ///< of the reference
  std::vector<std::vector<Vec2>> keep_out_px = {};  ///< polygons, image coordinates
};
MeasuredTrial measured_trial(
    const Scenario& s, std::uint64_t seed, const TrialOptions& options,
    const std::function<bool()>& stop = [] { return false; });

/// Times of the estimator and the controller together, s, one for each frame of a trial on this machine.
std::vector<double> cycle_times(const Scenario& s, std::uint64_t seed);

}  // namespace faba
