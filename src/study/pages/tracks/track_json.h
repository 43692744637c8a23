#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_measurement.h"

namespace faba {

/// Output of `faba track --json` (docs/formats/cli.md): parameters of detection and linking, mean-square
/// displacement, drift, diffusion and persistent walk, speeds, turns, order. Values have their standard error
/// and 95 % interval; lengths are also in um when the scale is known; unknown values are null.
nlohmann::ordered_json track_json(const TrackMeasurement& tracks);

/// "dark", "bright" or "both".
const char* word_of(Polarity polarity);
/// "median" or "spatial".
const char* background_word(const TrackDetection& detection);
/// "velocity" or "nearest".
const char* word_of(Motion motion);

}  // namespace faba
