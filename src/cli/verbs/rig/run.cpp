#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "app/bench/bench_session.h"
#include "app/bench/open_bench.h"
#include "app/recording/session.h"
#include "app/run/random_seed.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/process/child.h"
#include "study/pages/quality_output.h"
#include "study/pages/reported_run.h"
#include "study/pages/run_report.h"
#include "study/plot/markup.h"
#include "study/quality/scale_warning.h"
#include "study/steering/metrics.h"

namespace faba::cli {
namespace {

struct RigRunVerb {
  SceneOptions run;
  bool arm = false;
};

void print_latency(std::uint64_t frames, const Manifest::Bench& b) {
  const auto ms = [](double v) { return std::isnan(v) ? std::string("-") : three_digits(v) + " ms"; };
  fmt::print("frames {} received, {} dropped, {} corrupt; arrival {} after mid-exposure (median)\n", frames,
             b.frames_dropped, b.frames_corrupt, ms(b.arrival.median));
  fmt::print("command at the coils {} after frame arrival (median), 99.9 % within {}\n", ms(b.command.median),
             ms(b.command.p999));
  if (b.command_timeouts > 0)
    fmt::print("the coils were de-energised {} time{} because of a command timeout\n", b.command_timeouts,
               b.command_timeouts == 1 ? "" : "s");
}

int rig_run(const RigRunVerb& v, const Common& c) {
  Scenario s = read_bench_scene(v.run);
  const std::uint64_t seed = s.params.seed.value_or(random_seed());
  require_arm(v.arm);
  Progress bar("bench", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.run.out;
  if (o.out.empty()) o.out = fmt::format("runs/{}-bench", std::filesystem::path(v.run.scene).stem().string());
  o.numbered = v.run.out.empty();
  o.force = v.run.force;
  o.threads = v.run.threads;
  o.program = shell_word(program());
  reject_input_in_out(v.run);
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  const auto bench = std::make_shared<OpenBench>(s, seed);
  BenchSession session = BenchSession::begin(s, bench, seed, o);
  const bool complete = run_with_report(session);
  bar.clear();
  const Manifest& manifest = session.manifest();
  const Series series = session.series();
  const Metrics metrics = control_metrics(series, manifest.setpoint_tolerance_px, manifest.setpoints);
  if (!c.quiet)
    for (const std::string& note : manifest.notes)
      print_stderr(fmt::format("faba: note: {}: {}", v.run.scene, note));
  if (c.json) {
    Json j = {{"out", session.dir().string()}};
    for (const auto& source : {manifest_json(manifest), metrics_json(metrics)})
      for (const auto& [k, value] : source.items())
        if (!j.contains(k)) j[k] = value;
    add_warnings(j, scale_warnings(manifest.nominal_um_per_px));
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    fmt::print("{}\n", run_summary(metrics, run_info(manifest)).outcome);
    print_latency(manifest.frames, *manifest.bench);
    fmt::print("  report {}\n", (session.dir() / "report.html").string());
  }
  return complete ? 0 : int(Errc::interrupted);
}

}  // namespace

void add_rig_run(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<RigRunVerb>();
  CLI::App* v = verb(rig, line, "run", "Run the control loop of a scenario on the bench and record it",
                     "  faba rig run scenes/bench.toml --arm\n"
                     "  faba rig run scenes/bench.toml --arm --duration \"5 s\" --out runs/a");
  add_bench_scene(v, o->run);
  add_arm(v, o->arm);
  v->add_option("-o,--out", o->run.out, "Run directory; default: runs/SCENE-bench")->check(not_empty);
  v->add_option("--duration", o->run.duration,
                "Duration of the run, such as \"10 s\"; default: that of the scenario");
  v->add_flag("--force", o->run.force, "Replace an earlier run in the directory");
  v->callback([o, &line] { line.code = rig_run(*o, line.common); });
}

}  // namespace faba::cli
