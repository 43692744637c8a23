#include "cli/options/flow.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/parts.h"
#include "cli/command_line.h"

namespace faba::cli {

namespace {

// The default of a parameter as text: of the preset or the value in `defaults`, else of the part. Empty if
// it has no default.
std::string default_of(const Json& schema, const std::string& method, const std::string& key,
                       const FlowChoice& defaults) {
  const Json& properties = schema.at("properties");
  Json value = properties.at(key).value("default", Json());
  if (method == defaults.method)
    for (const auto& [given, text] : defaults.values) {
      if (given == key) return text;
      if (given != "preset") continue;
      const Json& preset = properties.at("preset").at("x-values").at(text);
      if (preset.contains(key)) value = preset.at(key);
    }
  return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump();
}

// Name of the type of a parameter in the help.
std::string type_of(const Json& property) {
  if (property.contains("enum"))
    return fmt::format("TEXT:{{{}}}", fmt::join(property["enum"].get<std::vector<std::string>>(), ","));
  if (property["type"] == "integer") return "INT";
  return property["type"] == "number" ? "FLOAT" : "TEXT";
}

std::string unit_suffix(const Json& property) {
  return property.contains("x-unit") ? " " + property["x-unit"].get<std::string>() : "";
}

}  // namespace

void add_flow_options(CLI::App* v, FlowOptions& o, const FlowChoice& defaults) {
  v->add_option(
       "--shrink", o.shrink,
       "Videos: first average frames over squares of N px; default: the smallest N for which no side is "
       "longer than 1024 px")
      ->check(integers(1, 64));
  v->add_option("--fps", o.fps,
                "Videos: frames per second, for videos that state no frame rate or a wrong one; default: "
                "that of the video")
      ->check(between(1e-6, 1e7));
  add_part_options(v, o.part);
  add_threads_option(v, o.threads);
  const FlowRegistry& methods = builtin_flow_methods();
  v->add_option("--method", o.method,
                fmt::format("Flow part: {}; default: {}", fmt::join(methods.names(), ", "), o.method))
      ->check(one_of(methods.names()))
      ->group("Flow");
  std::vector<std::string> names = methods.names();
  std::partition(names.begin(), names.end(), [&](const std::string& n) { return n == o.method; });
  for (const std::string& name : names) {
    const Json& schema = methods.json_schema(name);
    for (const auto& [key, property] : schema["properties"].items()) {
      // The description of a preset refers to the table of a file.
      std::string help = key == "preset" ? "Named set of default values; other options override it"
                                         : property["description"].get<std::string>();
      help += " (" + name;
      if (const std::string value = default_of(schema, name, key, defaults); !value.empty())
        help += fmt::format(", default: {}{}", value, unit_suffix(property));
      const std::string option = "--" + key;
      if (v->get_option_no_throw(option)) continue;
      CLI::Option* added = nullptr;
      if (property["type"] == "boolean")
        added = v->add_flag_callback(
            option, [&o, k = key] { o.values.emplace_back(k, "true"); }, help + ")");
      else
        added = v->add_option_function<std::string>(
                     option, [&o, k = key](const std::string& text) { o.values.emplace_back(k, text); },
                     help + ")")
                    ->type_name(type_of(property));
      added->group("Flow");
    }
  }
}

void add_response_options(CLI::App* v, ResponseOptions& o) {
  v->add_option("--direction", o.direction,
                "Direction of the response in degrees, clockwise in the picture: 0 right, 90 down, 270 up; "
                "default: measured")
      ->check(between(-360, 360));
  v->add_option("--flow-threshold", o.flow_threshold,
                "Threshold below which flow is noise, px per pair; default: measured")
      ->check(between(0, 1e9));
}

}  // namespace faba::cli
