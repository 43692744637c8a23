// What `faba tune` varies: the parameters of a scenario's controller, with their ranges.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "app/run/notes.h"
#include "app/run/simulation.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "control/setpoint_count.h"
#include "core/units.h"
#include "study/steering/metric_list.h"
#include "study/steering/tuning.h"

namespace faba {
namespace {

constexpr std::size_t kMostParameters = 8;

double end_of_range(const std::string& text, const std::string& unit, const std::string& range) {
  try {
    const Quantity q = parse_quantity(text);
    const Dimension wanted = unit.empty() ? Dimension{} : parse_unit(unit).dimension;
    if (q.dimension == wanted || (q.bare && unit == "px")) return q.value;
    throw std::invalid_argument(fmt::format("it must be a {}", dimension_name(wanted)));
  } catch (const std::invalid_argument& e) {
    throw Error(Errc::usage, "--range", fmt::format("\"{}\": \"{}\": {}", range, text, e.what()));
  }
}

// The keys of real numbers of a controller; integers are not varied.
std::vector<std::string> numbers_of(const Json& properties) {
  std::vector<std::string> keys;
  for (const auto& [key, field] : properties.items())
    if (field.contains("type") && (field["type"] == "number" || field["type"].is_array()))
      keys.push_back(key);
  return keys;
}

// "gain=0.1..2"
TunedParameter parameter_of(const std::string& range, const Json& properties) {
  const auto equals = range.find('='), dots = range.find("..");
  if (equals == std::string::npos || dots == std::string::npos || dots < equals)
    throw Error(Errc::usage, "--range",
                fmt::format("\"{}\" is not a range; write KEY=LOW..HIGH, such as gain=0.1..2", range));
  TunedParameter p{range.substr(0, equals), "", 0, 0, {}};
  const std::vector<std::string> keys = numbers_of(properties);
  if (std::find(keys.begin(), keys.end(), p.key) == keys.end())
    throw Error(
        Errc::usage, "--range",
        fmt::format("\"{}\" is not a real number of this controller{}", p.key, suggestion(p.key, keys)));
  p.unit = properties[p.key].value("x-unit", "");
  p.low = end_of_range(range.substr(equals + 1, dots - equals - 1), p.unit, range);
  p.high = end_of_range(range.substr(dots + 2), p.unit, range);
  if (!(p.low > 0) || !(p.high > p.low))
    throw Error(Errc::usage, "--range",
                fmt::format("\"{}\": the search is logarithmic; specify 0 < LOW < HIGH", range));
  const double least = properties[p.key].value("minimum", 0.0);
  const double most = properties[p.key].value("maximum", p.high);
  if (p.low < least || p.high > most)
    throw Error(Errc::usage, "--range",
                fmt::format("\"{}\": {} must be between {} and {}", range, p.key,
                            format_quantity(least, p.unit), format_quantity(most, p.unit)));
  return p;
}

std::vector<TunedParameter> all_parameters(const Json& properties) {
  std::vector<TunedParameter> all;
  for (const auto& [key, field] : properties.items())
    if (field.contains("x-tuned"))
      all.push_back({key,
                     field.value("x-unit", ""),
                     field["x-tuned"][0].get<double>(),
                     field["x-tuned"][1].get<double>(),
                     {}});
  return all;
}

void check_metric(const std::string& key, const Field& field) {
  std::vector<std::string> known;
  for (const MetricInfo* m : compared_metrics()) known.push_back(m->key);
  if (std::find(known.begin(), known.end(), key) == known.end())
    throw Error(Errc::usage, "--metric",
                fmt::format("\"{}\" is not a metric of controllers{}", key, suggestion(key, known)));
  if (key.starts_with("keep_out"))
    throw Error(Errc::usage, "--metric",
                fmt::format("{} is measured in the cases of `faba benchmark-control` only, which have "
                            "[[case.keep_out]]; choose another metric",
                            key));
  if (key != "coil_heat_w") return;
  for (std::size_t k = 0; k < field.coils(); ++k)
    if (field.circuit(k).resistance > 0) return;
  throw Error(
      Errc::usage, "--metric",
      "coil_heat_w is not known, because no coil of the field has a resistance; set resistance in each "
      "[[coil]] of the coil system, or choose another metric");
}

}  // namespace

TuningStudy new_tuning(const Document& scene, const TuningChoice& choice) {
  const Parts& parts = builtin_parts();
  TuningStudy study;
  study.scene = scene;
  const Scenario before = read_scenario(scene, parts);
  if (!choice.controller.empty() && choice.controller != before.controller.type)
    study.scene.set("controller", Json{{"type", choice.controller}}, "--controller");
  const Scenario s = read_scenario(study.scene, parts);
  study.controller = s.controller.type;
  Pool pool(1);
  const Simulation check(s, 1, pool);
  const std::size_t setpoints = setpoint_count(check.reference());
  if (setpoints == 0)
    throw Error(Errc::usage, scene.name,
                "has no setpoint, so that no controller can be tuned; add a [reference]");
  study.metric = choice.metric.empty() ? setpoints > 1 ? "iae_px_s" : "steady_rms_px" : choice.metric;
  check_metric(study.metric, *check.control().field);
  study.notes = scenario_notes(s, check, std::filesystem::current_path());
  const Json properties = parts.controller.json_schema(study.controller)["properties"];
  for (const std::string& range : choice.ranges) study.parameters.push_back(parameter_of(range, properties));
  if (choice.ranges.empty()) study.parameters = all_parameters(properties);
  if (study.parameters.empty() && numbers_of(properties).empty())
    throw Error(Errc::usage, "controller",
                fmt::format("\"{}\" has no number that can be tuned; choose another controller with "
                            "--controller, such as lqr",
                            study.controller));
  if (study.parameters.empty())
    throw Error(Errc::usage, "controller",
                fmt::format("\"{}\" has no parameter with a range for tuning; give one with --range "
                            "KEY=LOW..HIGH, such as {}, or another controller with --controller",
                            study.controller, fmt::join(numbers_of(properties), ", ")));
  if (study.parameters.size() > kMostParameters)
    throw Error(Errc::usage, "--range",
                fmt::format("{} parameters are too many for this search; give at most {}",
                            study.parameters.size(), kMostParameters));
  for (TunedParameter& p : study.parameters)
    if (const auto it = s.controller.resolved.find(p.key);
        it != s.controller.resolved.end() && !it->is_null())
      p.given = in_si(*it);
  return study;
}

}  // namespace faba
