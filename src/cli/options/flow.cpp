#include "cli/options/flow.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/parts.h"
#include "cli/command_line.h"
#include "core/units.h"

namespace faba::cli {

std::string in_seconds(std::string text) {
  try {
    const Quantity q = parse_quantity(text);
    return q.dimension == parse_unit("s").dimension ? fmt::format("{}", q.value) : text;
  } catch (const std::invalid_argument&) {
    return text;
  }
}

void add_flow_options(CLI::App* v, FlowOptions& o) {
  v->add_option(
       "--shrink", o.shrink,
       "Videos: first average frames over squares of N px; default: the smallest N for which no side is "
       "longer than 1024 px")
      ->check(CLI::Range(1, 64));
  v->add_option("--fps", o.fps,
                "Videos: frames per second, for videos that state no frame rate or a wrong one")
      ->check(between(1e-6, 1e7));
  v->add_option("--threads", o.threads,
                "Number of threads; default: all threads of the machine. Does not change the result")
      ->check(CLI::Range(1, 1024));
  const Parts parts = builtin_parts();
  v->add_option("--method", o.method, "Flow part: " + fmt::format("{}", fmt::join(parts.flow.names(), ", ")))
      ->check(one_of(parts.flow.names()))
      ->group("Flow");
  std::vector<std::string> names = parts.flow.names();
  std::partition(names.begin(), names.end(), [&](const std::string& n) { return n == o.method; });
  for (const std::string& name : names)
    for (const auto& [key, property] : parts.flow.json_schema(name)["properties"].items()) {
      std::string help = property["description"].get<std::string>() + " (" + name;
      if (property.contains("default")) help += ", default " + property["default"].dump();
      const std::string option = "--" + key;
      if (v->get_option_no_throw(option)) continue;
      CLI::Option* added =
          property["type"] == "boolean"
              ? v->add_flag_callback(
                    option, [&o, k = key] { o.values.emplace_back(k, "true"); }, help + ")")
              : v->add_option_function<std::string>(
                    option, [&o, k = key](const std::string& text) { o.values.emplace_back(k, text); },
                    help + ")");
      added->group("Flow");
    }
}

void add_response_options(CLI::App* v, ResponseOptions& o) {
  v->add_option("--direction", o.direction,
                "Direction of the response in degrees: 0 right, 90 down; default: measured")
      ->check(between(-360, 360));
  v->add_option("--flow-threshold", o.flow_threshold,
                "Threshold below which flow is noise, px per pair; default: measured")
      ->check(between(0, 1e9));
}

}  // namespace faba::cli
