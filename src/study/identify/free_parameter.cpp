#include "study/identify/free_parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/scenario.h"
#include "app/scenario/scenario_schema.h"
#include "core/error.h"
#include "core/units.h"

namespace faba {
namespace {

struct Shown {
  const char *unit, *name;
  double times;
};
constexpr Shown kShown[] = {
    {"m/s", "um/s", 1e6}, {"m", "um", 1e6}, {"m^2/s", "um^2/s", 1e12}, {"T", "uT", 1e6}};

/// Schema and value at a path.
struct Description {
  const Json* schema = nullptr;    ///< null: no such path
  const Json* value = nullptr;     ///< value at the path; null: none
  std::vector<std::string> known;  ///< permitted keys, when the path does not exist
};

std::vector<std::string> keys_of(const Json& properties) {
  std::vector<std::string> keys;
  for (const auto& [key, _] : properties.items()) keys.push_back(key);
  return keys;
}

// Schema of the part that the value selects among the alternatives.
const Json* chosen(const Json& schema, const Json* value) {
  const std::string type = !value               ? ""
                           : value->is_string() ? value->get<std::string>()
                           : value->is_object() && value->contains("type")
                               ? (*value)["type"].get<std::string>()
                               : "";
  for (const Json& one : schema["oneOf"])
    if (one.value("title", "") == type) return &one;
  return nullptr;
}

Description describe(const std::string& path, const Json& scenario) {
  static const Json all = scenario_json_schema(builtin_parts());
  const Json *schema = &all, *value = &scenario;
  std::size_t at = 0;
  while (at < path.size()) {
    const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
    const std::string key = path.substr(at, end - at);
    if (schema->contains("oneOf")) schema = chosen(*schema, value);
    if (!schema || !schema->contains("properties")) return {};
    if (!(*schema)["properties"].contains(key)) return {nullptr, nullptr, keys_of((*schema)["properties"])};
    schema = &(*schema)["properties"][key];
    value = value && value->is_object() && value->contains(key) ? &(*value)[key] : nullptr;
    at = end;
    if (at < path.size() && path[at] == '[') {
      const std::size_t close = path.find(']', at);
      if (close == std::string::npos || !schema->contains("items")) return {};
      const std::size_t index = std::size_t(std::strtoul(path.c_str() + at + 1, nullptr, 10));
      schema = &(*schema)["items"];
      value = value && value->is_array() && index < value->size() ? &(*value)[index] : nullptr;
      if (!value) return {};
      at = close + 1;
    }
    if (at < path.size() && path[at] == '.') ++at;
  }
  return {schema, value, {}};
}

double number(const Node& n, const FreeParameter& p) {
  if (n.json->is_number()) return n.json->get<double>();
  if (!n.json->is_string())
    n.fail("must be a number" + (p.unit.empty() ? "" : " or a quantity in " + p.unit));
  try {
    const Quantity q = parse_quantity(n.json->get<std::string>());
    const Dimension wanted = parse_unit(p.unit).dimension;
    if (q.dimension == wanted) return q.value;
    n.fail(fmt::format("\"{}\" is a {}; expected a {}", n.json->get<std::string>(),
                       dimension_name(q.dimension), dimension_name(wanted)));
  } catch (const std::invalid_argument&) {
  }
  n.fail(fmt::format("\"{}\" is not a {}", n.json->get<std::string>(),
                     p.unit.empty() ? "number" : "quantity in " + p.unit));
}

double quantity_of(const Json& v, const FreeParameter& p) {
  if (v.is_number()) return v.get<double>();
  return v.is_string() && !p.unit.empty() ? parse_quantity(v.get<std::string>()).value : 0;
}

// Tables that are set by the video, the study or the recording.
constexpr const char* kNotFree[] = {"title",  "seed",      "duration",  "camera",     "arena",   "record",
                                    "limits", "estimator", "reference", "controller", "library", "flow"};

FreeParameter read_one(const std::string& path, const Node& n, const Json* given, const Json& scenario) {
  const auto fail = [&](const std::string& what) { throw Error(Errc::usage, n.where(path), what); };
  for (const char* key : kNotFree)
    if (path.substr(0, path.find_first_of(".[")) == key)
      fail("cannot be a free parameter: the video or the study decides it");
  const Description d = describe(path, scenario);
  if (!d.schema) {
    const std::string key = path.substr(path.find_last_of('.') + 1);
    fail("no such value in the scenario" + suggestion(key, d.known));
  }
  const Json& s = *d.schema;
  if (!s.contains("minimum") || !s.contains("maximum"))
    fail("is not a number with a range, so it cannot be a free parameter");
  FreeParameter p{
      .path = path, .unit = s.value("x-unit", ""), .integer = s["type"] == "integer", .role = role_of(s)};
  const double least = s["minimum"].get<double>(), most = s["maximum"].get<double>();
  p.low = least;
  p.high = most;
  if (given && *given == false)
    fail("false is not permitted; remove the entry, or give true or [lowest, highest]");
  if ((!given || given->is_boolean()) && p.integer)
    fail("an integer parameter needs a range, such as [50, 1000]");
  const bool all = !given || given->is_boolean();
  if (all) {
    const double default_value = s.contains("default") ? quantity_of(s["default"], p) : 0;
    const double position = (default_value - p.low) / (p.high - p.low);
    if (position > 0 && position < 0.5) p.stretch = 2 * std::log(1 / position - 1);
  } else if (given->is_array()) {
    if (given->size() != 2) fail("must be [lowest, highest]");
    p.low = number({(*given)[0], n.path + "." + path, n.document}, p);
    p.high = number({(*given)[1], n.path + "." + path, n.document}, p);
  } else if (given->is_object() && given->contains("mean") && given->contains("sd")) {
    FreeParameter::NormalPrior k;
    k.mean = number({(*given)["mean"], n.path + "." + path, n.document}, p);
    k.sd = number({(*given)["sd"], n.path + "." + path, n.document}, p);
    if (!(k.sd > 0)) fail(fmt::format("sd {:g} must be greater than 0", k.sd));
    p.low = std::max(least, k.mean - 4 * k.sd);
    p.high = std::min(most, k.mean + 4 * k.sd);
    p.normal_prior = k;
  } else {
    fail("must be true, [lowest, highest] or { mean = ..., sd = ... }");
  }
  const std::string unit = p.shown_unit().empty() ? "" : " " + p.shown_unit();
  if (!(p.low < p.high))
    fail(fmt::format("must be [lowest, highest] with lowest < highest, not {:g} to {:g}{}", p.shown(p.low),
                     p.shown(p.high), unit));
  if (!(p.low >= least) || !(p.high <= most))
    fail(fmt::format("{:g} to {:g} is out of range; it must be a range within {:g} to {:g}{}", p.shown(p.low),
                     p.shown(p.high), p.shown(least), p.shown(most), unit));
  p.low_is_limit = p.low <= least;
  p.high_is_limit = p.high >= most;
  return p;
}

}  // namespace

std::string FreeParameter::name() const { return path.substr(path.find_last_of('.') + 1); }

std::string FreeParameter::shown_unit() const {
  for (const Shown& s : kShown)
    if (unit == s.unit) return s.name;
  return unit;
}

double FreeParameter::shown(double value) const {
  for (const Shown& s : kShown)
    if (unit == s.unit) return value * s.times;
  return value;
}

double FreeParameter::value(double u) const {
  const double linear = stretch != 0 ? std::expm1(stretch * u) / std::expm1(stretch) : u;
  const double v = low + (high - low) * linear;
  return integer ? std::floor(v + 0.5) : v;
}

double FreeParameter::fraction(double value) const {
  const double at = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return stretch != 0 ? std::log1p(at * std::expm1(stretch)) / stretch : at;
}

Json FreeParameter::json(double u) const {
  const double v = value(u);
  if (integer) return std::int64_t(v);
  return unit.empty() ? Json(v) : Json(fmt::format("{} {}", v, unit));
}

double FreeParameter::log_prior(double u) const {
  if (!normal_prior) return 0;
  const double z = (value(u) - normal_prior->mean) / normal_prior->sd;
  return -0.5 * z * z;
}

double read_value(const Node& n, const FreeParameter& p) {
  const double v = number(n, p);
  if (!(v >= p.low && v <= p.high))
    n.fail(fmt::format("{:g} is out of range; {} must be between {:g} and {:g}{}", v, p.path, p.low, p.high,
                       p.unit.empty() ? "" : " " + p.unit));
  return v;
}

std::optional<double> scenario_number(const std::string& path, const Json& scenario) {
  const Description d = describe(path, scenario);
  if (!d.schema) return {};
  const Json* v = d.value ? d.value : d.schema->contains("default") ? &(*d.schema)["default"] : nullptr;
  if (!v || !(v->is_number() || v->is_string())) return {};
  return v->is_number() ? v->get<double>() : parse_quantity(v->get<std::string>()).value;
}

std::vector<FreeParameter> read_free_parameters(const Node& free, const Json& scenario) {
  std::vector<FreeParameter> all;
  if (free.json->is_array()) {
    for (std::size_t i = 0; i < free.json->size(); ++i) {
      const Node n = free.item(i);
      if (!n.json->is_string()) n.fail("must be the path of a value, such as \"swarm[0].model.speed\"");
      all.push_back(read_one(n.json->get<std::string>(), free, nullptr, scenario));
    }
  } else if (free.json->is_object()) {
    for (const auto& [path, given] : free.json->items())
      all.push_back(read_one(path, free, &given, scenario));
  } else {
    free.fail("must be a list of paths or a table of paths and bounds");
  }
  if (all.size() > 8) free.fail(fmt::format("{} free parameters are too many; the maximum is 8", all.size()));
  return all;
}

}  // namespace faba
