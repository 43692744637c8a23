#include "cli/options/bench.h"

#include <CLI/CLI.hpp>

#include "app/scenario/read_scenario.h"
#include "core/error.h"

namespace faba::cli {

void add_bench_scene(CLI::App* v, SceneOptions& o) {
  v->add_option("scene", o.scene, "Scenario file (TOML) with a [rig]")->required();
  v->add_option("--set", o.set, "Change one value: PATH=VALUE")->take_all()->allow_extra_args(false);
  v->add_option("--seed", o.seed, "Seed of all randomness of a simulated bench");
  v->add_option("--threads", o.threads, "Threads; all of the machine's when absent")
      ->check(CLI::Range(1, 1024));
}

void add_arm(CLI::App* v, bool& arm) {
  v->add_flag("--arm", arm, "Allow current in the coils; give it only while somebody watches the coils");
}

Scenario read_bench_scene(const SceneOptions& o) {
  Document d = read_scene(o);
  d.set("camera.sensor", Json("frames"), "faba rig");
  return read_scenario(d, builtin_parts());
}

void require_arm(bool arm) {
  if (arm) return;
  throw Error(
      Errc::usage, "--arm",
      "is missing: the coils stay disarmed without it; give it while somebody watches the coils, or use "
      "`faba rig check`, which needs no current");
}

}  // namespace faba::cli
