#pragma once
#include <cstdint>

#include "app/scenario/scenario.h"

namespace faba {

/// What the manifest.json of any run says of its scenario and of the picture, simulated or on a bench
/// (docs/formats/run-directory.md). `frame` and `outline` are of the scenario's arena.
Json scenario_manifest(const Scenario& s, std::uint64_t seed, const Frame& frame, const Outline& outline);

}  // namespace faba
