#pragma once
#include <functional>
#include <optional>

#include "study/identify/identification.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Measures the videos, runs the simulations that are missing in `results`, and identifies the models. Empty
/// when other shards have tasks left. `reading` is called after each frame that is read. Throws Error(input)
/// for unsuitable videos, and the errors of sweep().
std::optional<Identification> identify(const IdentifyStudy& study, ResultStore& results,
                                       const SweepOptions& options, const std::function<void()>& reading);

/// identify() for videos that are measured already, without the rule of the thesis.
std::optional<Identification> identify(const IdentifyStudy& study, std::vector<ResponseVideo> videos,
                                       ResultStore& results, const SweepOptions& options);

}  // namespace faba
