#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/scenario/rig_file.h"
#include "app/scenario/scenario_schema.h"
#include "app/sinks/series_columns.h"
#include "cli/command_line.h"
#include "study/calibrate/calibration_study.h"
#include "study/engines/engine_settings.h"
#include "study/experiment/experiment.h"
#include "study/identify/identify.h"
#include "study/motion/activity_study.h"
#include "study/optics/optics_setup.h"
#include "study/steering/control_benchmark.h"
#include "study/steering/controller_study.h"
#include "study/uturn/moment_study.h"

namespace faba::cli {
namespace {

// Columns of series.csv, which a run writes; input files have a JSON Schema instead.
int schema_of_series(const Common& c) {
  Json columns = Json::array();
  for (const SeriesColumn& column : described_series_columns()) {
    columns.push_back({{"name", column.name},
                       {"unit", column.unit},
                       {"meaning", column.meaning},
                       {"simulated_only", column.simulated_only}});
    if (!c.json)
      fmt::print("{:<24} {:<3} {}{}\n", column.name, column.unit, column.meaning,
                 column.simulated_only ? "; simulations only" : "");
  }
  if (c.json) fmt::print("{}\n", Json{{"columns", columns}}.dump());
  return 0;
}

Json described_option(const CLI::Option& o) {
  Json j{{"name", o.get_positional()       ? o.get_name(true)
                  : o.get_lnames().empty() ? o.get_name()
                                           : "--" + o.get_lnames().front()},
         {"description", o.get_description()},
         {"type", o.get_items_expected_max() == 0 ? "flag" : o.get_type_name()}};
  if (o.get_positional()) j["positional"] = true;
  if (o.get_required()) j["required"] = true;
  if (o.get_items_expected_max() > 1) j["several"] = true;
  if (!o.get_snames().empty()) j["short"] = "-" + o.get_snames().front();
  return j;
}

// The verbs with their options, for completions, manual pages and the Python package.
Json described_verbs(const CLI::App& app, const std::string& parent) {
  Json all = Json::array();
  for (const CLI::App* v : app.get_subcommands([](const CLI::App*) { return true; })) {
    Json one{{"name", parent + v->get_name()},
             {"description", v->get_description()},
             {"footer", v->get_footer()},
             {"options", Json::array()}};
    for (const CLI::Option* o : v->get_options()) one["options"].push_back(described_option(*o));
    all.push_back(one);
    for (const Json& inner : described_verbs(*v, one["name"].get<std::string>() + " ")) all.push_back(inner);
  }
  return all;
}

int schema(const std::string& file, const CLI::App& app, const Common& c) {
  if (file == "series") return schema_of_series(c);
  if (file == "verbs") {
    fmt::print("{}\n", Json{{"verbs", described_verbs(app, "")}}.dump(c.json ? -1 : 2));
    return 0;
  }
  const Parts& parts = builtin_parts();
  const Json j = file == "rig"                   ? rig_file_json_schema(parts)
                 : file == "identify"            ? identify_study_schema()
                 : file == "calibrate"           ? calibration_study_schema()
                 : file == "compare-controllers" ? controller_study_schema()
                 : file == "benchmark-control"   ? control_benchmark_schema()
                 : file == "activity"            ? activity_study_schema()
                 : file == "moment"              ? moment_study_schema()
                 : file == "optics"              ? OpticsSetup::schema().json_schema()
                 : file == "experiment"          ? experiment_schema()
                 : file == "engine"              ? engine_file_schema()
                                                 : scenario_json_schema(parts);
  fmt::print("{}\n", j.dump(2));
  return 0;
}

}  // namespace

void add_schema(CLI::App& app, CommandLine& line) {
  CLI::App* v = verb(app, line, "schema",
                     "Print the JSON Schema of a scenario, coil system or study file, for editors and forms",
                     "  faba schema > scenario.json\n  faba schema rig > rig.json\n  faba schema series");
  const auto of = std::make_shared<std::string>("scenario");
  v->add_option(
       "kind", *of,
       "Kind of file: scenario (default), rig, experiment or engine; the verb that reads the study "
       "file; series, which lists the columns of series.csv; or verbs, which lists all commands with "
       "their options")
      ->check(one_of({"scenario", "rig", "identify", "calibrate", "compare-controllers", "benchmark-control",
                      "activity", "moment", "optics", "experiment", "engine", "series", "verbs"}));
  v->callback([of, &app, &line] { line.code = schema(*of, app, line.common); });
}

}  // namespace faba::cli
