#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {

void add_run_verbs(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<RunVerb>();
  CLI::App* v =
      verb(app, line, "run", "Run a scenario: the closed loop, headless and recorded",
           "  faba run scenes/steer.toml\n"
           "  faba run scenes/thesis-basic.toml --seed 7 --out runs/a --set swarm[0].model.max_speed=5\n"
           "  faba run scenes/drop.toml --from-video drop.tif --duration \"10 s\"");
  v->add_option("scene", o->scene, "Scenario file (TOML)")->required();
  v->add_option("--set", o->set, "Change one value: PATH=VALUE")->take_all()->allow_extra_args(false);
  v->add_option("--seed", o->seed, "Seed of all randomness; drawn and printed when absent");
  v->add_option("--threads", o->threads,
                "Threads; all of the machine's when absent. Never changes the result")
      ->check(CLI::Range(1, 1024));
  v->add_option("-o,--out", o->out, "Run directory; runs/SCENE-SEED when absent")->check(not_empty);
  v->add_option("--duration", o->duration, "Simulated time, such as \"10 s\"");
  v->add_option("--from-video", o->from_video, "Take the drop's edge from this picture or video")
      ->check(not_empty);
  v->add_flag("--as-seen", o->as_seen, "Videos show what the camera sees, not a drawing");
  v->add_flag("--force", o->force, "Replace an earlier run in the directory");
  v->callback([o, &line] { line.code = run(*o, line.common); });

  const auto again = std::make_shared<ResumeVerb>();
  v = verb(app, line, "resume", "Go on with an interrupted run from its last checkpoint",
           "  faba resume runs/steer-1");
  v->add_option("dir", again->dir, "Run directory")->required();
  v->add_option("--threads", again->threads, "Threads; all of the machine's when absent")
      ->check(CLI::Range(1, 1024));
  v->callback([again, &line] { line.code = resume(*again, line.common); });
}

void add_lab_verb(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<LabVerb>();
  CLI::App* v = verb(app, line, "lab", "The live lab: watch, steer and record a swarm in a browser",
                     "  faba lab\n  faba lab scenes/steer.toml\n  faba lab --no-browser --port 8765");
  v->add_option("scene", o->scene, "Scenario file to begin with");
  v->add_option("--port", o->port, "Port on 127.0.0.1; any that is free when absent")
      ->check(CLI::Range(0, 65535));
  v->add_flag("--no-browser", o->no_browser, "Only print the address");
  v->add_option("--threads", o->threads, "Threads; all of the machine's when absent")
      ->check(CLI::Range(1, 1024));
  v->add_option("--www", o->pages, "Take the page from this folder, while it is worked on")
      ->check(CLI::ExistingDirectory);
  v->callback([o, &line] { line.code = lab(*o, line.common); });
}

void add_help_verbs(CLI::App& app, CommandLine& line) {
  const auto p = std::make_shared<PartsVerb>();
  CLI::App* v =
      verb(app, line, "parts", "What can be named in a scenario, with units, ranges, defaults and sources",
           "  faba parts\n  faba parts model\n  faba parts model dipole");
  v->add_option(
      "kind", p->kind,
      "model, start, arena, field, motility, estimator, reference, controller, flow, camera, driver");
  v->add_option("name", p->name, "One part in full");
  v->callback([p, &line] { line.code = parts(*p, line.common); });

  v = verb(app, line, "schema", "JSON Schema of a scenario, rig or study file, for editors and forms",
           "  faba schema > scenario.json\n  faba schema rig > rig.json");
  const auto of = std::make_shared<std::string>("scenario");
  v->add_option("file", *of, "scenario (unless given) or rig; or the verb that takes the study file")
      ->check(CLI::IsMember({"scenario", "rig", "identify", "compare-controllers", "activity"}));
  v->callback([of, &line] { line.code = schema(*of, line.common); });
  v = verb(app, line, "doctor", "What this machine has", "  faba doctor");
  v->callback([&line] { line.code = doctor(line.common); });
}

}  // namespace faba::cli
