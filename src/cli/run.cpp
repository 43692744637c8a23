#include <fmt/format.h>

#include <cstdio>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "cli/progress.h"
#include "cli/scene.h"
#include "cli/verbs.h"
#include "study/pages/run_report.h"
#include "study/plot/markup.h"

namespace faba::cli {
namespace {

// The same run with another swarm: what a result is worth shows from the second one on.
std::string again_with(const RunVerb& v, std::uint64_t seed) {
  std::string line = fmt::format("{} run {} --seed {}", shell_word(program()), shell_word(v.scene), seed);
  if (!v.from_video.empty()) line += " --from-video " + shell_word(v.from_video);
  if (v.duration) line += " --duration " + shell_word(*v.duration);
  if (v.as_seen) line += " --as-seen";
  for (const std::string& s : v.set) line += " --set " + shell_word(s);
  return line;
}

void summary(const Session& session, const Manifest& manifest, const Metrics& m, const std::string& next) {
  const auto& dir = session.dir();
  fmt::print("{}\n", run_in_words(m, run_info(manifest)).outcome);
  const auto px = [](const std::optional<double>& v) { return v ? three_digits(*v) : std::string("-"); };
  if (m.setpoints > 0)
    fmt::print("settling time {}, steady error {} px rms, ",
               m.settling_time_s ? three_digits(*m.settling_time_s) + " s" : "never", px(m.steady_rms_px));
  if (m.cross_track_95_px) fmt::print("off the route {} px (95 %), ", px(m.cross_track_95_px));
  fmt::print("dispersion {} x {} px\n", px(m.sigma_x_px), px(m.sigma_y_px));
  const std::pair<const char*, const char*> files[] = {{"video", "video.mp4"},
                                                       {"exact", "video.avi"},
                                                       {"tracks", "tracks.h5"},
                                                       {"series", "series.csv"},
                                                       {"report", "report.html"}};
  for (const auto& [what, name] : files)
    if (std::filesystem::exists(dir / name)) fmt::print("  {:<7}{}\n", what, (dir / name).string());
  fmt::print("seed {}, state_hash {}\n", manifest.seed, manifest.simulated->state_hash);
  if (!next.empty()) fmt::print("now try: {}\n", next);
}

int carry_out(Session& session, Progress& bar, const Common& c, const std::string& next) {
  const bool whole = session.run();
  bar.clear();
  if (!whole) {
    if (!c.quiet)
      tell(fmt::format("faba: interrupted; what was recorded is kept. Go on with: {} resume {}",
                       shell_word(program()), shell_word(session.dir().string())));
    return int(Errc::interrupted);
  }
  const Manifest manifest = session.manifest();
  const Series series = session.series();
  write_run_report(session.dir(), run_info(manifest), series);
  session.complete();
  const Metrics metrics = control_metrics(series);
  if (c.json) {
    Json j = {{"out", session.dir().string()}};
    for (const auto& source : {manifest_json(manifest), metrics_json(metrics)})
      for (const auto& [k, v] : source.items())
        if (!j.contains(k)) j[k] = v;  // what both name is what the manifest says
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    summary(session, manifest, metrics, next);
  }
  return 0;
}

}  // namespace

int run(const RunVerb& v, const Common& c) {
  const Scenario s = read_scenario(read_scene(v), builtin_parts());

  const std::uint64_t seed = s.params.seed.value_or(drawn_seed());
  Progress bar("simulating", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.out;
  if (v.out.empty()) o.out = fmt::format("runs/{}-{}", std::filesystem::path(v.scene).stem().string(), seed);
  o.numbered = v.out.empty();
  o.force = v.force;
  o.program = shell_word(program());
  refuse_own_input(v);
  o.threads = v.threads;
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  Session session = Session::begin(s, seed, o);
  if (!c.quiet)
    for (const auto& note : session.notes()) tell(fmt::format("faba: note: {}: {}", v.scene, note));
  if (!s.params.seed && !c.quiet && !c.json)
    fmt::print("seed {} (drawn; --seed {} repeats this run)\n", seed, seed);
  return carry_out(session, bar, c, again_with(v, s.params.seed ? seed + 1 : 1));
}

int resume(const ResumeVerb& v, const Common& c) {
  Progress bar("simulating", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.dir;
  o.program = shell_word(program());
  o.threads = v.threads;
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  Session session = Session::resume(builtin_parts(), o);
  return carry_out(session, bar, c, "");
}

}  // namespace faba::cli
