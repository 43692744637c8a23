#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "study/data/provenance.h"
#include "study/motion/activity.h"
#include "study/pages/run_figures.h"

namespace faba {

/// "given", "recorded" by the run, or "detected" in the video.
const char* reversal_source(const Response& response);

/// A value with as many decimals as a twentieth of the width of its interval needs, at most six; two for a
/// width of zero.
std::string decimals(double value, double width);
inline double width_of(const std::array<double, 2>& interval) { return interval[1] - interval[0]; }

/// Output of `faba activity --json`: `videos[]` = `{"video", "exposure_s", "experiment", "pairs",
/// "threshold_px", "direction_deg", "direction_given", "segments":[{"t0_s","t1_s","direction_deg"}],
/// "mean_activity", "mean_along", "signal_to_noise", "responds",
/// "gaussian":{"amplitude","peak_s","sigma_s","offset", their "se_", "scatter", "good", "reason"}, "onset_s",
/// "onset_ci90", "responding_fraction", "speed_px_per_s", "speed_um_per_s", each with "_ci90", "response":
/// {"reversal_s", "reversal_source", "direction_deg", "method", "fraction_method", "t_statistic", "responds",
/// "rise_s", "displacement_px", "object_px", "neighbour_px", "flow_valid"}, "maximum_s", "departure_s",
/// "notes"}`, and with exposures `peak_line` and `mean_line` =
/// `{"slope","intercept","ci95","intercept_ci95","scatter_sd","experiment_sd","values","experiments","pooled":{..}}`,
/// `cutoff_s`, `cutoff_between_s`; null for unknown values.
nlohmann::ordered_json activity_json(const ActivityResult& result);

/// The signatures as CSV: `video,t0_s,t1_s,activity,along`; videos are numbered from 1.
std::string activity_csv(const ActivityResult& result);

/// Signature of each video with its segments, its Gaussian fit and the three points of the thesis; for videos
/// with air exposure times, the line fits against them.
std::vector<Figure> activity_figures(const ActivityResult& result);

/// HTML report.
std::string activity_page(const ActivityResult& result, const Provenance& provenance = {});

/// Writes the pair of frames with the largest activity as PNG: the flow, and beside it the flow above the
/// threshold and within 45 degrees of the direction (Fig. 3.27 of the thesis). Throws Error(usage,
/// "--picture") for a flow file, which has no frames.
void write_activity_picture(const std::filesystem::path& file, const VideoActivity& video);

}  // namespace faba
