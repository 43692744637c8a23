#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "study/identify/identification.h"
#include "study/stats/statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// 95 % confidence interval of the x at which a fitted line is zero (Fieller 1954), from the standard errors
/// of the fit; `mean_x`: mean of the x values. Empty when the slope is not significantly different from zero:
/// the interval is then unbounded.
std::optional<std::array<double, 2>> zero_crossing_ci95(const LineFit& line, double mean_x);

/// Runs the simulations that are missing in `results` and applies the rule of the thesis. Empty when other
/// shards have tasks left. `reading` as in identify().
std::optional<std::vector<LegacyModel>> legacy_selection(const IdentifyStudy& study,
                                                         const std::vector<ResponseVideo>& videos,
                                                         ResultStore& results, const SweepOptions& options,
                                                         const std::function<void()>& reading);

}  // namespace faba
