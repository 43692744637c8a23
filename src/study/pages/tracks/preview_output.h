#pragma once
#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "study/pages/tracks/track_report.h"
#include "study/tracks/track_preview.h"

namespace faba {

/// Makes the preview of a video, see preview_tracks(), and writes its frames with the spots as a contact
/// sheet to `picture`, a PNG. Throws as track_video().
TrackPreview preview_video(const TrackOptions& options, const std::filesystem::path& picture,
                           const TrackProgress& progress = {});

/// Output of `faba track --preview --json`: `detection` as in track_json(), and the number of spots in each
/// frame.
nlohmann::ordered_json preview_json(const TrackPreview& preview);

}  // namespace faba
