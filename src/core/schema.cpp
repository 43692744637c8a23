#include "core/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/counted.h"
#include "core/portable.h"
#include "core/units.h"

namespace faba {
namespace {

// Number of inserted, removed, replaced or (two neighbours) exchanged characters.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] =
          std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + std::size_t(a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string example(const FieldInfo& f) {
  if (f.unit.empty()) return "a number";
  if (f.unit == "deg") return "an angle such as 90 or \"90 deg\"";
  const Dimension dimension = parse_unit(f.unit).dimension;
  if (f.unit == "rad") return "an angle such as 1.5 or \"90 deg\"";
  // No cell lives at 1 K.
  if (dimension == parse_unit("K").dimension) return "a temperature such as \"293 K\"";
  if (dimension == Dimension{}) return fmt::format("a number such as 1 or \"1 {}\"", f.unit);
  return fmt::format("a {} such as \"1 {}\"", dimension_name(dimension), f.unit);
}

std::string shown(const Json& j) {
  const std::string s = j.dump(-1, ' ', false, Json::error_handler_t::replace);
  return s.size() > 60 ? s.substr(0, 57) + "..." : s;
}

constexpr double kOpen = std::numeric_limits<double>::max();

// Advice if only the type of a part was set on the command line: the table has the keys of its old type.
std::string set_type_advice(const Node& n) {
  if (!n.document || !n.has("type") || !n.json->at("type").is_string()) return "";
  const auto it = n.document->origin.find(n.path + ".type");
  if (it == n.document->origin.end() || it->second != "--set") return "";
  return fmt::format("; to change the type, replace the complete table: --set '{}={{type=\"{}\"}}'", n.path,
                     n.json->at("type").get<std::string>());
}

}  // namespace

Role role_of(const Json& described) {
  const std::string word = described.value("x-role", "");
  return Role(std::find(kRoleWords.begin(), kRoleWords.end(), word) - kRoleWords.begin());
}

double in_si(const Json& written) {
  return written.is_string() ? parse_quantity(written.get<std::string>()).value : written.get<double>();
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  std::size_t d_best = std::numeric_limits<std::size_t>::max();
  for (const auto& k : known)
    // A word with more than a third of its characters wrong is not a typing error.
    // Of two equally near words the longer one: characters are left out more often than exchanged.
    if (const std::size_t d = edit_distance(word, k);
        (d < d_best || (best && d == d_best && k.size() > best->size())) &&
        d <= std::max<std::size_t>(1, std::max(word.size(), k.size()) / 3)) {
      d_best = d;
      best = &k;
    }
  if (best) return fmt::format("; did you mean \"{}\"?", *best);
  return known.empty() ? "" : fmt::format("; known: {}", fmt::join(known, ", "));
}

namespace schema_detail {

namespace {

constexpr const char* kPixel = "px";  // numbers of pixels are written without a unit

// The unit of a quantity as written: "um/s" of "-3 um/s".
std::string unit_text(std::string_view quantity) {
  const std::size_t sign = quantity.find_first_not_of(" \t+");
  quantity.remove_prefix(std::min(sign, quantity.size()));
  double number = 0;
  const auto [end, error] = portable::from_chars(quantity.data(), quantity.data() + quantity.size(), number);
  const std::string_view rest = quantity.substr(std::size_t(end - quantity.data()));
  return std::string(rest.substr(std::min(rest.find_first_not_of(" \t"), rest.size())));
}

}  // namespace

void check_number(double v, const FieldInfo& f, const Node& n) {
  if (!std::isfinite(v)) n.fail(fmt::format("must be a finite number, got {}", v));
  if (v >= f.min && v <= f.max) return;
  // As in the file if it has a unit there: "-3 um/s", not "-3e-06 m/s".
  const bool with_unit = n.json->is_string() && !parse_quantity(n.json->get<std::string>()).bare;
  const std::string written = with_unit ? n.json->get<std::string>() : "";
  const std::string unit = with_unit ? unit_text(written) : f.unit;
  const double si = with_unit ? parse_unit(unit).value : 1;
  const auto limit = [&](double in_si) {  // ten digits: without the rounding errors of the conversion
    return with_unit ? fmt::format("{:.10g} {}", in_si / si, unit) : format_quantity(in_si, unit);
  };
  const std::string range = f.max == kOpen    ? fmt::format("at least {}", limit(f.min))
                            : f.min == -kOpen ? fmt::format("at most {}", limit(f.max))
                                              : fmt::format("between {} and {}", limit(f.min), limit(f.max));
  const std::string given = with_unit ? written
                            : unit.empty() || unit == kPixel
                                ? format_quantity(v, unit)
                                : fmt::format("{} (without a unit: {})", v, unit);
  const bool maybe_degrees = f.unit == "rad" && n.json->is_number();
  n.fail(fmt::format("{} is out of range; it must be {}{}", given, range,
                     maybe_degrees ? fmt::format("; for degrees write \"{:g} deg\"", v) : ""));
}

double read_number(const Node& n, const FieldInfo& f) {
  double v = 0;
  if (n.json->is_number()) {
    v = n.json->get<double>();
  } else if (n.json->is_string()) {
    const std::string text = n.json->get<std::string>();
    Quantity q;
    try {
      q = parse_quantity(text);
    } catch (const std::invalid_argument& e) {
      n.fail(fmt::format("{}; expected {}", e.what(), example(f)));
    }
    const Dimension wanted = parse_unit(f.unit).dimension;
    if (q.dimension != wanted && !(q.dimension == Dimension{}))
      n.fail(fmt::format("\"{}\" is a {}; expected {}", text, dimension_name(q.dimension), example(f)));
    // A bare number is in the unit of the schema, which may be degrees.
    v = q.bare ? q.value : q.value / parse_unit(f.unit).value;
  } else {
    n.fail(fmt::format("expected {}, got {}", example(f), shown(*n.json)));
  }
  check_number(v, f, n);
  return v;
}

std::int64_t read_integer(const Node& n, const FieldInfo& f) {
  if (!n.json->is_number()) {
    const bool bounded = f.min > -kOpen && f.max < kOpen;
    n.fail(fmt::format("expected an integer{}, got {}",
                       bounded ? fmt::format(" between {} and {}", f.min, f.max) : "", shown(*n.json)));
  }
  const double v = n.json->get<double>();
  check_number(v, f, n);
  if (v != std::floor(v)) n.fail(fmt::format("expected an integer, got {}", v));
  return n.json->is_number_integer() ? n.json->get<std::int64_t>() : std::int64_t(v);
}

bool read_flag(const Node& n) {
  if (!n.json->is_boolean()) n.fail(fmt::format("expected true or false, got {}", shown(*n.json)));
  return n.json->get<bool>();
}

std::string read_text(const Node& n, const FieldInfo& f) {
  if (!n.json->is_string()) n.fail(fmt::format("expected a string, got {}", shown(*n.json)));
  if (!f.choices.empty()) read_choice(n, f);
  return n.json->get<std::string>();
}

std::size_t read_choice(const Node& n, const FieldInfo& f) {
  const std::string word = n.json->is_string() ? n.json->get<std::string>() : shown(*n.json);
  const auto it = std::find(f.choices.begin(), f.choices.end(), word);
  if (it == f.choices.end()) n.fail(fmt::format("\"{}\" is not one of {}", word, fmt::join(f.choices, ", ")));
  return std::size_t(it - f.choices.begin());
}

void require_array(const Node& n, std::size_t exact) {
  if (!n.json->is_array()) n.fail(fmt::format("expected an array in [ ], got {}", shown(*n.json)));
  if (exact && n.json->size() != exact)
    n.fail(fmt::format("expected {}, got {}", counted(exact, "value"), n.json->size()));
}

Json number_json(double v, const FieldInfo& f) {
  if (f.unit.empty() || f.unit == "px") return v;
  return format_quantity(v, f.unit);
}

Json type_json(const char* type, const FieldInfo& f, const Json& fallback) {
  Json j;
  if (std::string(type) == "number" && !f.unit.empty())
    j["type"] = {"number", "string"};
  else
    j["type"] = type;
  if (!f.title.empty()) j["title"] = f.title;
  if (!f.doc.empty()) j["description"] = f.doc;
  if (!f.unit.empty()) j["x-unit"] = f.unit;
  if (!f.choices.empty()) j["enum"] = f.choices;
  const bool numeric = std::string(type) == "number" || std::string(type) == "integer";
  if (numeric && f.min > -kOpen) j["minimum"] = f.min;
  if (numeric && f.max < kOpen) j["maximum"] = f.max;
  if (!fallback.is_null()) j["default"] = fallback;
  if (!f.source.empty()) j["x-source"] = f.source;
  if (!f.tuned.empty()) j["x-tuned"] = f.tuned;
  if (f.role != Role::none) j["x-role"] = kRoleWords.at(std::size_t(f.role));
  return j;
}

void Fields::add(std::string key, std::size_t at, const ValueType& type, FieldInfo info,
                 const void* defaults) {
  Json fallback = type.dump(static_cast<const char*>(defaults) + at, info);
  fields_.push_back({std::move(key), std::move(info), at, &type, std::move(fallback)});
}

void Fields::include(const Fields& other, std::size_t at) {
  for (Field f : other.fields_) {
    f.at += at;
    fields_.push_back(std::move(f));
  }
  for (const Rule& rule : other.rules)
    rules.emplace_back([rule, at](const void* p) { return rule(static_cast<const char*>(p) + at); });
  for (const Rule& rule : other.advice)
    advice.emplace_back([rule, at](const void* p) { return rule(static_cast<const char*>(p) + at); });
}

const Fields::Field* Fields::find(const std::string& key) const {
  const auto it = std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) {
    return f.key == key || (!key.empty() && f.info.old_key == key);
  });
  return it == fields_.end() ? nullptr : &*it;
}

std::optional<std::size_t> Fields::chosen_preset(const Node& n) const {
  if (!n.json->is_object()) n.fail("must be a table of parameters");
  if (presets.empty() || !n.has("preset")) return {};
  FieldInfo names;
  for (const auto& preset : presets) names.choices.push_back(preset.first);
  return read_choice(n.child("preset"), names);
}

void Fields::read(void* to, const Node& n, const std::vector<std::string>& extra) const {
  for (const auto& [key, value] : n.json->items()) {
    if (key == "preset" && !presets.empty()) continue;
    if (std::find(extra.begin(), extra.end(), key) != extra.end()) continue;
    const Field* f = find(key);
    if (!f) {
      std::vector<std::string> known = extra;
      for (const Field& field : fields_) known.push_back(field.key);
      if (!presets.empty()) known.emplace_back("preset");
      throw Error(Errc::usage, n.where(key), "unknown key" + set_type_advice(n) + suggestion(key, known));
    }
    if (key != f->key && n.has(f->key))
      throw Error(Errc::usage, n.where(key),
                  fmt::format("is the old name of \"{}\"; give only one of them", f->key));
    f->type->read(static_cast<char*>(to) + f->at, n.child(key), f->info);
  }
  for (const Rule& rule : rules)
    if (const std::string wrong = rule(to); !wrong.empty()) n.fail(wrong);
}

std::vector<std::string> Fields::notes(const void* of) const {
  std::vector<std::string> all;
  for (const Rule& rule : advice)
    if (std::string text = rule(of); !text.empty()) all.push_back(std::move(text));
  return all;
}

Json Fields::to_json(const void* from) const {
  Json j = Json::object();
  for (const Field& f : fields_)
    if (Json v = f.type->dump(static_cast<const char*>(from) + f.at, f.info); !v.is_null())
      j[f.key] = std::move(v);
  return j;
}

Json Fields::json_schema(const std::vector<const void*>& preset_values) const {
  Json properties = Json::object();
  for (const Field& f : fields_) properties[f.key] = f.type->describe(f.info, f.fallback);
  Json j = {{"title", name}, {"description", summary}, {"type", "object"}, {"additionalProperties", false}};
  if (!presets.empty()) {
    Json names = Json::array();
    Json sources = Json::object(), values = Json::object();
    for (std::size_t i = 0; i < presets.size(); ++i) {
      names.push_back(presets[i].first);
      sources[presets[i].first] = presets[i].second;
      values[presets[i].first] = to_json(preset_values[i]);
    }
    properties["preset"] = {
        {"type", "string"},
        {"enum", names},
        {"x-source", sources},
        {"x-values", values},
        {"description", "Named set of default values; other keys of the table override it"}};
  }
  if (!validity.empty()) j["x-validity"] = validity;
  j["properties"] = properties;
  return j;
}

}  // namespace schema_detail
}  // namespace faba
