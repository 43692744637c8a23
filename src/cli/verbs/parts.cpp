#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/scenario.h"
#include "app/scenario/scenario_schema.h"
#include "cli/command_line.h"

namespace faba::cli {
namespace {

struct PartsVerb {
  std::string kind, name;
};

std::string shown_value(const Json& j) { return j.is_string() ? j.get<std::string>() : j.dump(); }

std::string range_of(const Json& f) {
  if (f.contains("enum")) {
    std::string s;
    for (const auto& e : f["enum"]) s += (s.empty() ? "" : " | ") + e.get<std::string>();
    return s;
  }
  const std::string unit = f.value("x-unit", "");
  std::string s;
  if (f.contains("minimum") && f.contains("maximum"))
    s = fmt::format("{:g} ... {:g}", f["minimum"].get<double>(), f["maximum"].get<double>());
  else if (f.contains("minimum"))
    s = fmt::format(">= {:g}", f["minimum"].get<double>());
  return s.empty() ? unit : unit.empty() ? s : s + " " + unit;
}

// Values of a preset that differ from the defaults.
std::string overrides(const Json& values, const Json& properties) {
  std::string out;
  for (const auto& [key, value] : values.items())
    if (const Json& f = properties[key]; !f.contains("default") || f["default"] != value)
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", key, shown_value(value));
  return out.empty() ? "the defaults" : out;
}

void describe(const Json& schema, const std::string& indent) {
  for (const auto& [key, f] : schema["properties"].items()) {
    std::string line = fmt::format("{}{}", indent, key);
    if (f.contains("default") && f["default"].dump() != "\"\"") line += " = " + shown_value(f["default"]);
    if (const std::string range = range_of(f); !range.empty()) line += fmt::format("   ({})", range);
    fmt::print("{}\n", line);
    if (f.contains("description")) fmt::print("{}    {}\n", indent, f["description"].get<std::string>());
    if (f.contains("x-source")) {
      if (f["x-source"].is_string())
        fmt::print("{}    source: {}\n", indent, f["x-source"].get<std::string>());
      else
        for (const auto& [name, source] : f["x-source"].items())
          fmt::print("{0}    {1}: {2}\n{0}        {3}\n", indent, name, source.get<std::string>(),
                     overrides(f["x-values"][name], schema["properties"]));
    }
    if (f.contains("properties")) describe(f, indent + "    ");
    if (!f.contains("items")) continue;
    if (f["items"].contains("properties")) describe(f["items"], indent + "    ");
    if (f["items"].contains("oneOf")) {
      std::string kinds;
      for (const auto& one : f["items"]["oneOf"])
        kinds += (kinds.empty() ? "" : " | ") + one["properties"]["type"]["const"].get<std::string>();
      fmt::print("{}    type   ({}), and the keys of that type\n", indent, kinds);
    }
  }
}

int parts(const PartsVerb& v, const Common& c) {
  const Parts& all = builtin_parts();
  Json out = Json::object();
  std::vector<std::string> kinds;
  each_kind(all, [&](const char* kind, const auto& registry) {
    kinds.emplace_back(kind);
    for (const auto& name : registry.names()) out[kind][name] = registry.json_schema(name);
  });
  if (!v.kind.empty() && !out.contains(v.kind))
    throw Error(Errc::usage, "parts",
                fmt::format("unknown kind \"{}\"{}", v.kind, suggestion(v.kind, kinds)));
  if (!v.name.empty() && !out[v.kind].contains(v.name)) {
    std::vector<std::string> names;
    for (const auto& [k, _] : out[v.kind].items()) names.push_back(k);
    throw Error(Errc::usage, "parts",
                fmt::format("unknown {} \"{}\"{}", v.kind, v.name, suggestion(v.name, names)));
  }
  if (c.json) {
    fmt::print("{}\n", (v.kind.empty() ? out : v.name.empty() ? out[v.kind] : out[v.kind][v.name]).dump());
    return 0;
  }
  if (!v.name.empty()) {
    const Json& one = out[v.kind][v.name];
    fmt::print("{} \"{}\": {}\n", v.kind, v.name, one["description"].get<std::string>());
    if (one.contains("x-validity"))
      fmt::print("Limits of validity: {}\n", one["x-validity"].get<std::string>());
    fmt::print("\n");
    describe(one, "  ");
    return 0;
  }
  std::size_t widest = 0;
  each_kind(all, [&](const char*, const auto& registry) {
    for (const auto& name : registry.names()) widest = std::max(widest, name.size());
  });
  each_kind(all, [&](const char* kind, const auto& registry) {
    if (!v.kind.empty() && v.kind != kind) return;
    fmt::print("{}: {}\n", kind, registry.doc());
    for (const auto& name : registry.names())
      fmt::print("  {:<{}}  {}\n", name, widest,
                 registry.json_schema(name)["description"].template get<std::string>());
  });
  fmt::print("\nParameters of a part: faba parts KIND NAME, for example faba parts model dipole\n");
  return 0;
}

}  // namespace

void add_parts(CLI::App& app, CommandLine& line) {
  const auto p = std::make_shared<PartsVerb>();
  CLI::App* v = verb(app, line, "parts",
                     "List the parts that a scenario can name, with units, ranges, defaults and sources",
                     "  faba parts\n  faba parts model\n  faba parts model dipole");
  v->add_option(
      "kind", p->kind,
      "Kind: model, start, arena, field, motility, estimator, reference, controller, flow, camera, driver");
  v->add_option("name", p->name, "Part whose parameters are printed");
  v->callback([p, &line] { line.code = parts(*p, line.common); });
}

}  // namespace faba::cli
