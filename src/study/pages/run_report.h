#pragma once
#include <filesystem>
#include <string>

#include "study/data/run_info.h"
#include "study/data/series.h"
#include "study/steering/metric_list.h"

namespace faba {

/// What came of a run, in plain sentences. Lengths in pixels, and in micrometres when the picture scale is
/// known.
struct RunInWords {
  std::string
      outcome;  ///< one sentence: whether and when the swarm reached its setpoint, and how near it stayed
  std::string details;  ///< how well it kept to its route, and how far it is spread at the end; may be empty
};
RunInWords run_in_words(const Metrics& metrics, const RunInfo& info);

/// Writes `report.html` of a run into its directory (temporary name, then renamed; an older report is
/// replaced): these sentences, the metrics in px and um, the figures, the video when `video.mp4` exists, and
/// what is needed to repeat the run, with `scenario.toml` when it is there. The page is one file that needs
/// no network and no script; only the video stays outside. Throws Error(Errc::input) for a series without the
/// columns that it needs, Error(Errc::internal) when the report cannot be written.
void write_run_report(const std::filesystem::path& run_dir, const RunInfo& info, const Series& series);

}  // namespace faba
