#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/scenario/read_scenario.h"
#include "cli/command_line.h"
#include "cli/options/scene.h"
#include "cli/provenance.h"
#include "study/pages/steering/design_report.h"
#include "study/steering/loop_design.h"

namespace faba::cli {
namespace {

int design(const SceneOptions& v, const Common& c) {
  const Scenario s = read_scenario(read_scene(v), builtin_parts());
  const LoopDesign found = loop_design(s);
  if (c.json) print_json(design_json(found), provenance_of(c, {v.scene}));
  if (!c.json && !c.quiet)
    for (const std::string& note : found.notes) print_stderr("faba: note: " + note);
  if (!c.json && !c.quiet) fmt::print("{}", design_text(found));
  return 0;
}

}  // namespace

void add_design(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<SceneOptions>();
  CLI::App* v =
      verb(app, line, "design", "Gains, poles and stability margins of the controller of a scenario",
           "  faba design scenes/bench.toml --set 'controller={type=\"lqr\"}'\n"
           "  faba design scenes/bench.toml --set 'controller={type=\"lqr\",error_px=5}' --json");
  v->add_option("scene", o->scene, "Scenario file (TOML), or an example such as bench")
      ->required()
      ->transform(or_example("scenes"));
  v->add_option("--set", o->set, "Set one value of the scenario: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->callback([o, &line] { line.code = design(*o, line.common); });
}

}  // namespace faba::cli
