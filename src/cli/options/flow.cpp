#include "cli/options/flow.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/parts.h"
#include "cli/command_line.h"
#include "core/units.h"

namespace faba::cli {

std::string in_seconds(std::string word) {
  try {
    const Quantity q = parse_quantity(word);
    return q.dimension == parse_unit("s").dimension ? fmt::format("{}", q.value) : word;
  } catch (const std::invalid_argument&) {
    return word;
  }
}

void add_flow_options(CLI::App* v, FlowOptions& o) {
  v->add_option("--shrink", o.shrink,
                "Videos: average frames over squares of so many px first; unless given, until no side is "
                "above 1024 px")
      ->check(CLI::Range(1, 64));
  v->add_option("--fps", o.fps, "Videos: frames per second, where they do not state them or not truly")
      ->check(between(1e-6, 1e7));
  v->add_option("--threads", o.threads, "Threads; all of the machine's when absent. Never changes the result")
      ->check(CLI::Range(1, 1024));
  const Parts parts = builtin_parts();
  v->add_option("--method", o.method, "Flow part: " + fmt::format("{}", fmt::join(parts.flow.names(), ", ")))
      ->check(CLI::IsMember(parts.flow.names()))
      ->group("Flow");
  std::vector<std::string> names = parts.flow.names();
  std::partition(names.begin(), names.end(), [&](const std::string& n) { return n == o.method; });
  for (const std::string& name : names)
    for (const auto& [key, property] : parts.flow.json_schema(name)["properties"].items()) {
      std::string words = property["description"].get<std::string>() + " (" + name;
      if (property.contains("default")) words += ", " + property["default"].dump();
      const std::string option = "--" + key;
      if (v->get_option_no_throw(option)) continue;
      CLI::Option* added =
          property["type"] == "boolean"
              ? v->add_flag_callback(
                    option, [&o, k = key] { o.values.emplace_back(k, "true"); }, words + ")")
              : v->add_option_function<std::string>(
                    option, [&o, k = key](const std::string& text) { o.values.emplace_back(k, text); },
                    words + ")");
      added->group("Flow");
    }
}

void add_response_options(CLI::App* v, ResponseOptions& o) {
  v->add_option("--direction", o.direction,
                "Direction of the response in degrees: 0 right, 90 down; found when absent")
      ->check(between(-360, 360));
  v->add_option("--flow-threshold", o.flow_threshold,
                "Flows of less are noise, px per pair; found when absent")
      ->check(between(0, 1e9));
}

}  // namespace faba::cli
