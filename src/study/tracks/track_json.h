#pragma once
#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_statistics.h"

namespace faba {

/// The members of `faba track --json` that say how things move (docs/formats/cli.md): msd, drift, diffusion,
/// persistent_walk, supported, persistence, memory_frames, alpha, speed, turn, order. Numbers that do not
/// exist are null. With um_per_px > 0 what has px in its name is there again in um.
nlohmann::ordered_json track_json(const TrackSummary& summary, double um_per_px);

}  // namespace faba
