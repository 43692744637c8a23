#pragma once
#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_measurement.h"

namespace faba {

/// Output of `faba track --json` (docs/formats/cli.md): parameters of detection and linking, mean-square
/// displacement, drift, diffusion and persistent walk with their misfit, motion of the stage, quality of the
/// tracks, speeds, turns, order. Values have their standard error and 95 % interval; lengths are also in um
/// when the scale is known; unknown values are null, and the mean speed with several populations.
nlohmann::ordered_json track_json(const TrackMeasurement& tracks);

/// The members of this output that describe the motion of the tracks: from `tracks` to `mean_order`, and
/// `populations`.
nlohmann::ordered_json motion_json(const TrackSummary& summary,
                                   const std::vector<SpeedPopulation>& populations,
                                   const std::optional<double>& um_per_px);

/// The member `detection` of this output.
nlohmann::ordered_json detection_json(const TrackDetection& detection);

/// "dark", "bright" or "both".
const char* word_of(Polarity polarity);
/// "median" or "spatial".
const char* background_word(const TrackDetection& detection);
/// "velocity" or "nearest".
const char* word_of(Motion motion);

}  // namespace faba
