#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/bench/step_response.h"
#include "app/run/random_seed.h"
#include "app/scenario/read_scenario.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/process/child.h"
#include "study/pages/run_report.h"
#include "study/plot/markup.h"

namespace faba::cli {
namespace {

struct StepResponseVerb {
  SceneOptions run;
  std::optional<std::string> exposure, repeat, every;
  std::string experiment;
  bool arm = false;
};

int rig_step_response(const StepResponseVerb& v, const Common& c) {
  StepResponseJob job;
  job.scene = read_scene(v.run);
  if (v.exposure) job.scene.set("exposure", *v.exposure, "--exposure");
  if (v.repeat) job.scene.set("rig.step_response.repeat", *v.repeat, "--repeat");
  if (v.every) job.scene.set("rig.step_response.every", *v.every, "--every");
  const Scenario s = read_scenario(job.scene, builtin_parts());
  require_rig(s, v.run);
  job.seed = s.params.seed.value_or(random_seed());
  require_arm(v.arm);
  if (const std::string note = schedule_note(s.rig->step_response); !note.empty() && !c.quiet)
    print_stderr(fmt::format("faba: note: {}", note));
  job.experiment = v.experiment;
  Progress bar("bench", !c.quiet && !c.json);
  job.run.out = v.run.out;
  if (job.run.out.empty())
    job.run.out = fmt::format("runs/{}-response", std::filesystem::path(v.run.scene).stem().string());
  job.run.threads = v.run.threads;
  job.run.program = shell_word(program());
  job.run.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  job.run.stop = &stop_requested();
  Json all = Json::array();
  job.done = [&](const RecordedResponse& r) {
    bar.clear();
    write_run_report(r.dir, read_run_info(r.dir / run_files::kManifest), read_series(r.dir / "series.csv"));
    all.push_back({{"out", r.dir.string()},
                   {"exposure_s", r.exposure},
                   {"cells", r.cells},
                   {"swarm_px", r.at_px ? Json{r.at_px->x, r.at_px->y} : Json()},
                   {"frames", r.frames},
                   {"frames_dropped", r.dropped}});
    if (c.json || c.quiet) return;
    fmt::print("{}: air exposure time {:.0f} s, {}; {} frames, {} dropped\n", r.dir.string(), r.exposure,
               r.at_px ? fmt::format("about {} cells, centroid ({:.0f}, {:.0f}) px", three_digits(r.cells),
                                     r.at_px->x, r.at_px->y)
                       : "no swarm detected",
               r.frames, r.dropped);
    std::fflush(stdout);
  };
  const auto study = job.run.out / "study.toml";
  record_step_responses(job);
  bar.clear();
  if (c.json)
    fmt::print("{}\n", Json{{"study", study.string()}, {"responses", all}}.dump());
  else if (!c.quiet)
    fmt::print("next: {} activity {}\n", shell_word(program()), shell_word(study.string()));
  return 0;
}

}  // namespace

void add_rig_step_response(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<StepResponseVerb>();
  CLI::App* v = verb(
      rig, line, "step-response",
      "Record step responses: gather the swarm at one side, reverse the field, record; repeat on a schedule",
      "  faba rig step-response scenes/exposure.toml --arm\n"
      "  faba rig step-response scenes/exposure.toml --arm --exposure \"90 s\" --repeat 8 --every \"80 s\" "
      "--out runs/ageing\n"
      "  faba activity runs/ageing/study.toml");
  add_bench_scene(v, o->run);
  add_arm(v, o->arm);
  v->add_option("-o,--out", o->run.out,
                "Directory of the study, which may contain earlier responses; default: runs/SCENE-response")
      ->check(not_empty);
  v->add_option("--exposure", o->exposure,
                "Air exposure time of the sample at the start of the command, such as \"90 s\"; default: "
                "exposure in the scenario");
  v->add_option("--repeat", o->repeat,
                "Number of responses; default: rig.step_response.repeat in the scenario");
  v->add_option("--every", o->every,
                "Time from the start of one response to the start of the next, such as \"80 s\"; default: "
                "rig.step_response.every in the scenario");
  v->add_option("--experiment", o->experiment, "Name of the drop; default: a number")->check(not_empty);
  v->callback([o, &line] { line.code = rig_step_response(*o, line.common); });
}

}  // namespace faba::cli
