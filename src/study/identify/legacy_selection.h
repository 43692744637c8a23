#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "study/identify/identification.h"
#include "study/motion/flow_histograms.h"
#include "study/stats/statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// 95 % confidence interval of the x at which a fitted line is zero (Fieller 1954), from the standard errors
/// of the fit; `mean_x`: mean of the x values. Empty when the slope is not significantly different from zero:
/// the interval is then unbounded.
std::optional<std::array<double, 2>> zero_crossing_ci95(const LineFit& line, double mean_x);

/// The first segment of an episode as flow histograms of all pairs of frames, as in the thesis.
struct LegacyReference {
  std::vector<double> times_s;  ///< of the frames, from the start of the episode
  FlowFilter filter;
  std::vector<FlowHistograms> pairs;
};
/// Of each episode of each video.
using LegacyReferences = std::vector<std::vector<LegacyReference>>;

/// Reads the videos. `reading` as in identify().
LegacyReferences legacy_references(const std::vector<ResponseVideo>& videos,
                                   const std::function<void()>& reading);

/// Description of the round of these simulations, see Round.
inline constexpr const char* kLegacyRound = "legacy 1";
/// The simulations as tasks; the arguments must outlive them.
Round legacy_round(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                   const LegacyReferences& references);

/// Runs the simulations that are missing in `results` and applies the rule of the thesis. Empty when other
/// shards have tasks left.
std::optional<std::vector<LegacyModel>> legacy_selection(const IdentifyStudy& study,
                                                         const std::vector<ResponseVideo>& videos,
                                                         const LegacyReferences& references,
                                                         ResultStore& results, const SweepOptions& options);

}  // namespace faba
