#pragma once
#include <filesystem>
#include <string>

#include "study/data/run_info.h"
#include "study/data/series.h"
#include "study/steering/metric_list.h"
#include "vision/image/small_frame.h"

namespace faba {

/// Summary of a run in sentences. Lengths in pixels, and in micrometres when the picture scale is known.
struct RunSummary {
  std::string outcome;  ///< one sentence: settling time and steady-state error
  std::string details;  ///< cross-track error and final dispersion; may be empty
  /// Sentence with the setpoint to which the settling time and the steady-state error refer when the run
  /// ended before the last setpoint of its route; else empty.
  std::string setpoint = {};
};
RunSummary run_summary(const Metrics& metrics, const RunInfo& info);

/// Writes `report.html` into the directory of a run (temporary name, then renamed; replaces an older report):
/// summary, metrics in px and um, figures, the video if `video.mp4` exists, and the data to reproduce the
/// run, with `scenario.toml` if it exists. The page needs no network and no script; only the video is a
/// separate file. `frames`: frames of the video; if empty, the video is decoded. Throws Error(Errc::input)
/// when mandatory columns of the series are missing, Error(Errc::internal) when the report cannot be written.
void write_run_report(const std::filesystem::path& run_dir, const RunInfo& info, const Series& series,
                      const std::vector<SmallFrame>& frames = {});

}  // namespace faba
