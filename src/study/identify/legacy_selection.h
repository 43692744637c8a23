#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "study/identify/identification.h"
#include "study/stats/statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Ends of the interval for the x at which a line is zero (Fieller 1954), from its own standard errors about
/// the mean of x; empty when the slope may be zero, so that it has no bounds.
std::optional<std::array<double, 2>> zero_crossing_ci95(const LineFit& line, double mean_x);

/// Simulates what `results` has not yet. Empty when other shards have tasks left. `reading` as identify().
std::optional<std::vector<LegacyModel>> legacy_selection(const IdentifyStudy& study,
                                                         const std::vector<ResponseVideo>& videos,
                                                         ResultStore& results, const SweepOptions& options,
                                                         const std::function<void()>& reading);

}  // namespace faba
