#pragma once
#include <functional>
#include <optional>

#include "study/identify/identification.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Surveys the videos, simulates what `results` has not yet, and concludes. Empty when other shards have
/// tasks left. `reading` is called after each frame that is read. Throws Error(input) for
/// videos that do not do, and what sweep() throws.
std::optional<Identification> identify(const IdentifyStudy& study, ResultStore& results, SweepOptions options,
                                       const std::function<void()>& reading);

}  // namespace faba
