#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_measurement.h"

namespace faba {

/// What `faba track --json` prints (docs/formats/cli.md): how spots were found and joined, mean-square
/// displacement, drift, diffusion and persistent walk, speeds, turns, order. Values carry their standard
/// error and 95 % interval; lengths are given in um, too, where the scale is known; null where there is none.
nlohmann::ordered_json track_json(const TrackMeasurement& tracks);

/// "dark", "bright" or "both".
const char* word_of(Polarity polarity);
/// "median" or "spatial".
const char* background_word(const TrackDetection& detection);
/// "velocity" or "nearest".
const char* word_of(Motion motion);

}  // namespace faba
