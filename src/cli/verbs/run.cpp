#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/recording/session.h"
#include "app/run/random_seed.h"
#include "app/scenario/read_scenario.h"
#include "cli/command_line.h"
#include "cli/options/scene.h"
#include "cli/progress.h"
#include "cli/recorded_run.h"
#include "core/process/child.h"

namespace faba::cli {
namespace {

// The same run with another seed, to see how much results vary.
std::string command_with_seed(const SceneOptions& v, std::uint64_t seed) {
  std::string line = fmt::format("{} run {} --seed {}", shell_word(program()), shell_word(v.scene), seed);
  if (!v.from_video.empty()) line += " --from-video " + shell_word(v.from_video);
  if (v.duration) line += " --duration " + shell_word(*v.duration);
  if (v.as_seen) line += " --as-seen";
  for (const std::string& s : v.set) line += " --set " + shell_word(s);
  return line;
}

int run(const SceneOptions& v, const Common& c) {
  std::string drop_note;
  const Document scene = read_scene(v, &drop_note);
  const Scenario s = read_scenario(scene, builtin_parts());
  const std::uint64_t seed = s.params.seed.value_or(random_seed());
  Progress bar("simulating", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.out;
  if (v.out.empty()) o.out = fmt::format("runs/{}-{}", std::filesystem::path(v.scene).stem().string(), seed);
  o.numbered = v.out.empty();
  o.force = v.force;
  o.program = shell_word(program());
  reject_input_in_out(v);
  o.threads = v.threads;
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  Session session = Session::begin(s, seed, o);
  if (!c.quiet && !drop_note.empty()) print_stderr("faba: note: " + drop_note);
  if (!c.quiet)
    for (const auto& note : session.notes()) print_stderr(fmt::format("faba: note: {}: {}", v.scene, note));
  if (!s.params.seed && !c.quiet && !c.json)
    fmt::print("seed {} (random; --seed {} repeats this run)\n", seed, seed);
  return run_session(session, bar, c, command_with_seed(v, s.params.seed ? seed + 1 : 1));
}

}  // namespace

void add_run(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<SceneOptions>();
  CLI::App* v =
      verb(app, line, "run", "Run the control loop of a scenario, without display, and record it",
           "  faba run scenes/steer.toml\n"
           "  faba run scenes/thesis-basic.toml --seed 7 --out runs/a --set swarm[0].model.max_speed=5\n"
           "  faba run scenes/drop.toml --from-video drop.tif --duration \"10 s\"");
  v->add_option("scene", o->scene, "Scenario file (TOML), or an example such as steer")
      ->required()
      ->transform(or_example("scenes"));
  v->add_option("--set", o->set, "Set one value of the scenario: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->add_option(
       "--seed", o->seed,
       "Seed of all random numbers; default: that of the scenario, else a random seed, which is printed")
      ->type_name("INT");
  v->add_option("--threads", o->threads,
                "Number of threads; default: all threads of the machine. Does not change the result")
      ->check(integers(1, 1024));
  v->add_option("-o,--out", o->out,
                "Run directory; default: runs/SCENE-SEED; if it exists, runs/SCENE-SEED-2, -3, ...")
      ->check(not_empty);
  v->add_option("--duration", o->duration, "Simulated time, such as \"10 s\"; default: that of the scenario");
  v->add_option("--from-video", o->from_video, "Use the drop detected in this picture or video as the arena")
      ->check(not_empty);
  v->add_flag("--as-seen", o->as_seen, "Record videos as the camera sees them, not drawings");
  v->add_flag("--force", o->force, "Replace an earlier run in the directory");
  v->callback([o, &line] { line.code = run(*o, line.common); });
}

}  // namespace faba::cli
