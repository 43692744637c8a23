#pragma once
#include "app/scenario/scenario.h"
#include "cli/options/scene.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// Adds the scenario file of a bench verb, --set, --seed and --threads.
void add_bench_scene(CLI::App* v, SceneOptions& o);
/// Adds --arm.
void add_arm(CLI::App* v, bool& arm);

/// The scenario with camera.sensor = "frames": a bench camera gives pictures, not cell positions. Throws
/// Error(usage) if it has no [rig].
Scenario read_bench_scene(const SceneOptions& o);
/// Throws Error(usage) with the name of the file if the scenario has no [rig].
void require_rig(const Scenario& s, const SceneOptions& o);
/// Throws Error(usage, "--arm") if --arm was not given.
void require_arm(bool arm);

}  // namespace faba::cli
