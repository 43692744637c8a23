#include "cli/options/bench.h"

#include <CLI/CLI.hpp>

#include "app/scenario/read_scenario.h"
#include "cli/command_line.h"
#include "core/error.h"

namespace faba::cli {

void add_bench_scene(CLI::App* v, SceneOptions& o) {
  v->add_option("scene", o.scene, "Scenario file (TOML) with the table [rig], or an example such as bench")
      ->required()
      ->transform(or_example("scenes"));
  v->add_option("--set", o.set, "Set one value of the scenario: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->add_option("--seed", o.seed,
                "Seed of all random numbers of a simulated bench; default: that of the scenario")
      ->type_name("INT");
  v->add_option("--threads", o.threads, "Number of threads; default: all threads of the machine")
      ->check(integers(1, 1024));
}

void add_arm(CLI::App* v, bool& arm) {
  v->add_flag("--arm", arm, "Permit current in the coils; use it only while a person supervises the coils");
}

Scenario read_bench_scene(const SceneOptions& o) {
  Document d = read_scene(o);
  d.set("camera.sensor", Json("frames"), "faba rig");
  Scenario s = read_scenario(d, builtin_parts());
  require_rig(s, o);
  return s;
}

void require_rig(const Scenario& s, const SceneOptions& o) {
  if (s.rig) return;
  throw Error(Errc::usage, o.scene, "the table [rig] is missing; add it, as in scenes/bench.toml");
}

void require_arm(bool arm) {
  if (arm) return;
  throw Error(Errc::usage, "--arm",
              "option is missing; without it the coils stay disarmed. Use --arm only while a person "
              "supervises the coils; `faba rig check` works without current");
}

}  // namespace faba::cli
