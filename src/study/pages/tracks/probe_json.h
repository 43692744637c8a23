#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_probe.h"

namespace faba {

/// Spots of a frame as lists of x_px, y_px, size_px and snr; `detection` as in track_json(), for this frame;
/// quality and warnings.
nlohmann::ordered_json probe_json(const ProbedFrame& frame);
/// Tracks over some frames, each a list of frame, x_px and y_px.
nlohmann::ordered_json links_json(const ProbedLinks& links);

}  // namespace faba
