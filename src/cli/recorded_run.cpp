#include "cli/recorded_run.h"

#include <fmt/format.h>

#include "app/recording/session.h"
#include "cli/command_line.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/process/child.h"
#include "study/pages/quality_output.h"
#include "study/pages/reported_run.h"
#include "study/pages/run_report.h"
#include "study/plot/markup.h"
#include "study/quality/scale_warning.h"

namespace faba::cli {
namespace {

// One cell has no dispersion.
void print_metrics(const Metrics& m, bool several_cells) {
  const auto px = [](const std::optional<double>& v) { return v ? three_digits(*v) : std::string("-"); };
  if (m.setpoints > 0)
    fmt::print("settling time{}, steady-state error {} px rms, ",
               m.settling_time_s ? " " + three_digits(*m.settling_time_s) + " s" : ": not settled",
               px(m.steady_rms_px));
  if (m.cross_track_95_px) fmt::print("cross-track error {} px (95th percentile), ", px(m.cross_track_95_px));
  if (several_cells)
    fmt::print("dispersion {} x {} px\n", px(m.sigma_x_px), px(m.sigma_y_px));
  else
    fmt::print("dispersion -\n");
}

void print_run_summary(const Session& session, const Manifest& manifest, const Metrics& m,
                       const std::string& next) {
  const auto& dir = session.dir();
  const RunSummary summary = run_summary(m, run_info(manifest));
  fmt::print("{}\n", summary.outcome);
  if (m.frames > 1 && !manifest.two_swarm_distances_px) print_metrics(m, manifest.simulated->cells > 1);
  if (!summary.setpoint.empty()) fmt::print("{}\n", summary.setpoint);
  const std::pair<const char*, const char*> files[] = {{"video", "video.mp4"},
                                                       {"lossless", "video.avi"},
                                                       {"tracks", "tracks.h5"},
                                                       {"series", "series.csv"},
                                                       {"report", "report.html"}};
  for (const auto& [what, name] : files)
    if (std::filesystem::exists(dir / name)) fmt::print("  {:<9}{}\n", what, (dir / name).string());
  fmt::print("seed {}, state_hash {}\n", manifest.seed, manifest.simulated->state_hash);
  if (!next.empty()) fmt::print("To run it with another seed: {}\n", next);
}

}  // namespace

int run_session(Session& session, Progress& bar, const Common& c, const std::string& next) {
  const bool complete = run_with_report(session);
  bar.clear();
  if (!complete) {
    if (!c.quiet)
      print_stderr(
          fmt::format("faba: interrupted; the recorded data are kept. Resume the run with: {} resume {}",
                      shell_word(program()), shell_word(session.dir().string())));
    return int(Errc::interrupted);
  }
  const Manifest manifest = session.manifest();
  const Series series = session.series();
  const Metrics metrics = control_metrics(series, manifest.setpoint_tolerance_px, manifest.setpoints);
  if (c.json) {
    Json j = {{"out", session.dir().string()}};
    for (const auto& source : {manifest_json(manifest), metrics_json(metrics)})
      for (const auto& [k, v] : source.items())
        if (!j.contains(k)) j[k] = v;  // the manifest has precedence
    add_warnings(j, scale_warnings(manifest.nominal_um_per_px));
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    print_run_summary(session, manifest, metrics, next);
  }
  return 0;
}

}  // namespace faba::cli
