#pragma once
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "study/motion/activity.h"
#include "study/pages/run_figures.h"

namespace faba {

/// What `faba activity --json` prints: `videos[]` = `{"video", "exposure_s", "experiment", "pairs",
/// "threshold_px", "direction_deg", "direction_given", "segments":[{"t0_s","t1_s","direction_deg"}],
/// "mean_activity", "mean_along", "signal_to_noise", "responds",
/// "gaussian":{"amplitude","peak_s","sigma_s","offset", their "se_", "scatter", "good", "why"}, "onset_s",
/// "maximum_s", "leaving_s", "notes"}`, and with exposures `peak_line` and `mean_line` =
/// `{"slope","intercept","ci95","intercept_ci95","scatter_sd","experiment_sd","values","experiments","pooled":{..}}`,
/// `cutoff_s`, `cutoff_between_s`; null for what could not be found.
nlohmann::ordered_json activity_json(const ActivityResult& result);

/// The signatures as CSV: `video,t0_s,t1_s,activity,along`, the video by its number from 1 on.
std::string activity_csv(const ActivityResult& result);

/// Signature of each video with its segments, its fit and the thesis's three points; and with exposures the
/// lines.
std::vector<Figure> activity_figures(const ActivityResult& result);

/// All of it as one page.
std::string activity_page(const ActivityResult& result);

/// Writes the busiest pair of a video as PNG: all its flow, and beside it that which is left behind the
/// threshold and the cone of 45 degrees (the thesis's Fig. 3.27). Throws Error(usage, "--picture") for flows
/// from a file, which have no frames.
void write_activity_picture(const std::filesystem::path& file, const VideoActivity& video);

}  // namespace faba
