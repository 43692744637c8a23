// Range ends of every number of every part, including nested tables.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "tests/contract/contract.h"

using namespace faba;

namespace {

/// A range end that a part refuses because of a rule over several keys, with defaults for the others.
struct Refused {
  std::string at;      ///< "kind part key end"; also for a coil of a coil system
  std::string phrase;  ///< part of the error message
};
const std::vector<Refused> kRefused{
    {"model dipole speed maximum", "reduce speed or increase speed_max"},
    {"model dipole speed_max minimum", "is above speed_max"},
    {"field helmholtz radius minimum", "wire_radius must be smaller than radius"},
    {"field helmholtz wire_radius maximum", "wire_radius must be smaller than radius"},
    {"field loop radius minimum", "wire_radius must be smaller than radius"},
    {"field loop wire_radius maximum", "wire_radius must be smaller than radius"},
    {"field solenoid wire_radius maximum", "wire_radius must be smaller than radius"},
    {"field solenoid core_radius maximum", "core_radius must not be above radius"},
    {"field thick_coil inner_radius maximum", "outer_radius must be larger than inner_radius"},
    {"field thick_coil outer_radius minimum", "outer_radius must be larger than inner_radius"},
    {"controller fuzzy near_px maximum", "must not be larger than far_px"},
    {"controller fuzzy far_px minimum", "must not be larger than far_px"},
    {"controller compact compact_px maximum", "must be larger than compact_px"},
    {"controller compact spread_px minimum", "must be larger than compact_px"},
    {"controller mpc obstacle.corners_px minimum", "a polygon has an area"},
    {"controller mpc obstacle.corners_px maximum", "a polygon has an area"},
};

/// The key of a number in the tables of this file: a coil of a coil system has the rules of the coil part.
std::string listed_at(const std::string& key) {
  const std::string list = "field rig coil[";
  if (!key.starts_with(list)) return key;
  std::string coil = "field " + key.substr(list.size());
  if (const auto dot = coil.find("]."); dot != std::string::npos) return coil.replace(dot, 2, " ");
  coil.pop_back();
  return coil;
}

/// Other keys that a table needs to be complete.
Json beside(const std::string& table) {
  static const std::map<std::string, Json> all{
      {"field rig", {{"coil", Json::array({"loop"})}}},
      {"field map", {{"expansion", {{"coefficients", {0, 0, 0}}}}}},
      {"field map expansion", {{"coefficients", {0, 0, 0}}}},
      {"reference route", {{"setpoints_px", {{100, 120}}}}},
      {"controller mpc obstacle", {{"corners_px", {{0, 0}, {9, 0}, {0, 9}}}}},
      {"controller fuzzy set", {{"trapezoid_px", {0, 0, 1, 1}}}},
      {"camera playback", {{"file", "a video"}}},
  };
  const auto it = all.find(listed_at(table));
  return it == all.end() ? Json::object() : it->second;
}

/// Length of a list of numbers.
std::size_t count_of(const std::string& key, const Json& schema) {
  if (key.ends_with(".coefficients")) return 3;
  if (key.ends_with(".trapezoid_px")) return 4;
  if (key.ends_with(".corners_px") && schema["items"].contains("items")) return 3;
  if (key == "reference path points_px" && schema["items"].contains("items")) return 2;
  return schema.value("minItems", std::size_t{1});
}

/// A number of a part: its schema, and the table of the part with a value of it.
struct Number {
  std::string key;  ///< as in "field rig coil[loop].position"
  const Json& schema;
  std::function<Json(const Json&)> table;
};
using Wrap = std::function<Json(const Json&)>;
using VisitNumber = std::function<void(const Number&)>;

void each_number(const std::string& key, const Json& schema, const Wrap& table, const VisitNumber& visit);

/// Visits the numbers of a table; `start`: its other keys.
void each_number_within(const std::string& at, const std::string& separator, const Json& properties,
                        const Json& start, const Wrap& table, const VisitNumber& visit) {
  for (const auto& item : properties.items()) {
    const std::string& key = item.key();
    const auto wrap = [&table, &start, &key](const Json& value) {
      Json t = start;
      if (key == "inductance") t["resistance"] = 1;
      t[key] = value;
      return table(t);
    };
    each_number(at + separator + key, item.value(), wrap, visit);
  }
}

/// Visits all numbers of a schema; `table` makes the table of the part from a value.
void each_number(const std::string& key, const Json& schema, const Wrap& table, const VisitNumber& visit) {
  if (schema.contains("minimum") || schema.contains("maximum")) {
    visit({key, schema, table});
  } else if (schema.contains("oneOf")) {
    for (const Json& one : schema["oneOf"]) {
      if (!one.contains("properties")) continue;  // a name without parameters
      const Json& type = one["properties"]["type"]["const"];
      const std::string at = fmt::format("{}[{}]", key, type.get<std::string>());
      Json start = beside(at);
      start["type"] = type;
      each_number_within(at, ".", one["properties"], start, table, visit);
    }
  } else if (schema.contains("properties")) {
    each_number_within(key, ".", schema["properties"], beside(key), table, visit);
  } else if (schema.contains("items")) {
    const std::size_t n = count_of(key, schema);
    const auto wrap = [&table, n](const Json& value) { return table(Json(n, value)); };
    each_number(key, schema["items"], wrap, visit);
  }
}

/// Every number of every part: visit(registry, number).
template <class Visit>
void each_number_of_parts(Visit&& visit) {
  each_kind(contract::parts(), [&](const char* kind, const auto& registry) {
    for (const auto& name : registry.names()) {
      const std::string at = fmt::format("{} {}", kind, name);
      Json start = beside(at);
      start["type"] = name;
      each_number_within(
          at, " ", registry.json_schema(name)["properties"], start, [](const Json& table) { return table; },
          [&](const Number& n) { visit(registry, n); });
    }
  });
}

/// Error message for a table; empty if it is accepted.
template <class R>
std::string refusal(const R& registry, const Json& table) {
  try {
    contract::resolved(registry, table);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("every number of every part: its range ends are accepted, or refused by a rule over several keys") {
  std::set<std::string> used;
  int numbers = 0;
  each_number_of_parts([&](const auto& registry, const Number& n) {
    ++numbers;
    for (const std::string end : {"minimum", "maximum"}) {
      if (!n.schema.contains(end)) continue;
      const std::string here = listed_at(n.key) + " " + end, why = refusal(registry, n.table(n.schema[end]));
      const auto known =
          std::find_if(kRefused.begin(), kRefused.end(), [&](const Refused& r) { return r.at == here; });
      INFO(n.key, " ", end, ": ", why);
      if (known == kRefused.end()) {
        CHECK(why == "");
      } else {
        used.insert(here);
        CHECK(why.find(known->phrase) != std::string::npos);
      }
    }
  });
  CHECK(numbers > 100);
  for (const Refused& r : kRefused) {
    INFO(r.at, " is accepted, or does not exist: remove it from the table");
    CHECK(used.count(r.at) == 1);
  }
}

TEST_CASE(
    "every number of every part: values out of range and non-finite values are refused with the reason") {
  each_number_of_parts([&](const auto& registry, const Number& n) {
    INFO(n.key);
    for (const std::string end : {"minimum", "maximum"}) {
      if (!n.schema.contains(end)) continue;
      const double limit = n.schema[end].template get<double>(), step = std::max(1.0, std::fabs(limit));
      const Json beyond = end == "minimum" ? limit - step : limit + step;
      const std::string why = refusal(registry, n.table(beyond));
      INFO(end, ": ", why);
      CHECK(why.find("is out of range; it must be") != std::string::npos);
    }
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      const std::string why = refusal(registry, n.table(bad));
      INFO(why);
      CHECK(why.find("must be a finite number") != std::string::npos);
    }
  });
}
