#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/scenario/rig_file.h"
#include "app/scenario/scenario_schema.h"
#include "cli/command_line.h"
#include "study/identify/identify.h"
#include "study/motion/activity.h"
#include "study/steering/controller_study.h"

namespace faba::cli {
namespace {

int schema(const std::string& file, const Common&) {
  const Parts parts = builtin_parts();
  const Json j = file == "rig"                   ? rig_file_json_schema(parts)
                 : file == "identify"            ? identify_study_schema()
                 : file == "compare-controllers" ? controller_study_schema()
                 : file == "activity"            ? activity_study_schema()
                                                 : scenario_json_schema(parts);
  fmt::print("{}\n", j.dump(2));
  return 0;
}

}  // namespace

void add_schema(CLI::App& app, CommandLine& line) {
  CLI::App* v =
      verb(app, line, "schema", "JSON Schema of a scenario, rig or study file, for editors and forms",
           "  faba schema > scenario.json\n  faba schema rig > rig.json");
  const auto of = std::make_shared<std::string>("scenario");
  v->add_option("file", *of, "scenario (unless given) or rig; or the verb that takes the study file")
      ->check(CLI::IsMember({"scenario", "rig", "identify", "compare-controllers", "activity"}));
  v->callback([of, &line] { line.code = schema(*of, line.common); });
}

}  // namespace faba::cli
