#pragma once
#include <filesystem>
#include <string>

#include "study/data/run_info.h"
#include "study/steering/metrics.h"

namespace faba {

/// What came of a run, in plain sentences. Lengths in pixels, and in micrometres when the picture scale is
/// known.
struct RunInWords {
  std::string
      outcome;  ///< one sentence: whether and when the swarm reached its setpoint, and how near it stayed
  std::string details;  ///< how well it kept to its route, and how far it is spread at the end; may be empty
};
RunInWords run_in_words(const Metrics& metrics, const RunInfo& info);

/// Reads `series.csv` and `manifest.json` of a run, and `scenario.toml` when it is there, and writes
/// `report.html` beside them (temporary name, then renamed; an older report is replaced): these sentences,
/// the metrics in px and um, the figures, the video when `video.mp4` exists, and what is needed to repeat the
/// run. The page is one file that needs no network and no script; only the video stays outside. Throws
/// Error(Errc::input) for a file that is missing or unsuitable, Error(Errc::internal) when the report cannot
/// be written.
void write_run_report(const std::filesystem::path& run_dir);

}  // namespace faba
