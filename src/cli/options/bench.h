#pragma once
#include "app/scenario/scenario.h"
#include "cli/options/scene.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// The scenario file of a verb for the bench, --set, --seed and --threads.
void add_bench_scene(CLI::App* v, SceneOptions& o);
/// --arm
void add_arm(CLI::App* v, bool& arm);

/// The scenario with a camera that tells no cells, as a bench has.
Scenario read_bench_scene(const SceneOptions& o);
/// Throws Error(usage, "--arm") unless it was given.
void require_arm(bool arm);

}  // namespace faba::cli
