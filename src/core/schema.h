#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/toml.h"
#include "core/vec.h"

namespace faba {

/// What is said about one parameter. Numbers with a unit may be given as "186 um/s"; a bare number is in
/// `unit`.
struct FieldInfo {
  std::string unit = {};                             ///< SI unit (or px); empty for a pure number
  double min = -std::numeric_limits<double>::max();  ///< in `unit`
  double max = std::numeric_limits<double>::max();
  std::string doc = {};                   ///< one sentence
  std::string source = {};                ///< where the default comes from; "assumed" when nobody measured it
  std::vector<std::string> choices = {};  ///< allowed words, in the order of the enum
};

namespace schema_detail {
double read_number(const Node& n, const FieldInfo& f);
std::int64_t read_integer(const Node& n, const FieldInfo& f);
bool read_flag(const Node& n);
std::string read_text(const Node& n, const FieldInfo& f);
std::size_t read_choice(const Node& n, const FieldInfo& f);
void check_number(double v, const FieldInfo& f, const Node& n);
void require_array(const Node& n, std::size_t exact_size_or_zero);
Json number_json(double v, const FieldInfo& f);
Json type_json(const char* type, const FieldInfo& f, const Json& fallback);

template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};
template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};
template <class T>
concept Described = requires {
  T::schema();
};

template <class T>
T read(const Node& n, const FieldInfo& f) {
  if constexpr (std::is_same_v<T, bool>) {
    return read_flag(n);
  } else if constexpr (std::is_same_v<T, double>) {
    return read_number(n, f);
  } else if constexpr (std::is_integral_v<T>) {
    return T(read_integer(n, f));
  } else if constexpr (std::is_enum_v<T>) {
    return T(read_choice(n, f));
  } else if constexpr (std::is_same_v<T, std::string>) {
    return read_text(n, f);
  } else if constexpr (std::is_same_v<T, Vec2>) {
    require_array(n, 2);
    return {read_number(n.item(0), f), read_number(n.item(1), f)};
  } else if constexpr (std::is_same_v<T, Vec3>) {
    require_array(n, 3);
    return {read_number(n.item(0), f), read_number(n.item(1), f), read_number(n.item(2), f)};
  } else if constexpr (is_optional<T>::value) {
    return read<typename T::value_type>(n, f);
  } else if constexpr (is_vector<T>::value) {
    require_array(n, 0);
    T v;
    for (std::size_t i = 0; i < n.json->size(); ++i) v.push_back(read<typename T::value_type>(n.item(i), f));
    return v;
  } else {
    static_assert(Described<T>,
                  "a parameter's type must be known to the schema or have a schema() of its own");
    return T::schema().parse(n);
  }
}

template <class T>
Json dump(const T& v, const FieldInfo& f) {
  if constexpr (std::is_same_v<T, bool> || std::is_integral_v<T> || std::is_same_v<T, std::string>) {
    return v;
  } else if constexpr (std::is_same_v<T, double>) {
    return number_json(v, f);
  } else if constexpr (std::is_enum_v<T>) {
    return f.choices.at(std::size_t(v));
  } else if constexpr (std::is_same_v<T, Vec2>) {
    return Json::array({number_json(v.x, f), number_json(v.y, f)});
  } else if constexpr (std::is_same_v<T, Vec3>) {
    return Json::array({number_json(v.x, f), number_json(v.y, f), number_json(v.z, f)});
  } else if constexpr (is_optional<T>::value) {
    return v ? dump(*v, f) : Json();
  } else if constexpr (is_vector<T>::value) {
    Json j = Json::array();
    for (const auto& e : v) j.push_back(dump(e, f));
    return j;
  } else {
    return T::schema().to_json(v);
  }
}

template <class T>
Json describe(const FieldInfo& f, const Json& fallback) {
  if constexpr (std::is_same_v<T, bool>) {
    return type_json("boolean", f, fallback);
  } else if constexpr (std::is_same_v<T, double>) {
    return type_json("number", f, fallback);
  } else if constexpr (std::is_integral_v<T>) {
    return type_json("integer", f, fallback);
  } else if constexpr (std::is_enum_v<T> || std::is_same_v<T, std::string>) {
    return type_json("string", f, fallback);
  } else if constexpr (is_optional<T>::value) {
    return describe<typename T::value_type>(f, fallback);
  } else if constexpr (std::is_same_v<T, Vec2> || std::is_same_v<T, Vec3>) {
    Json j = type_json("array", f, fallback);
    j["items"] = type_json("number", f, Json());
    j["minItems"] = j["maxItems"] = std::is_same_v<T, Vec2> ? 2 : 3;
    return j;
  } else if constexpr (is_vector<T>::value) {
    Json j = type_json("array", f, fallback);
    j["items"] = describe<typename T::value_type>(f, Json());
    return j;
  } else {
    return T::schema().json_schema();
  }
}
}  // namespace schema_detail

/// One parameter as documentation, forms and bounds see it.
struct FieldDescription {
  std::string key;
  FieldInfo info;
  Json fallback;     ///< the default, as it would stand in a scenario
  Json json_schema;  ///< JSON Schema of the value
};

/// "; did you mean "speed"?" when `word` is near one of `known`, else "".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Describes a plain struct P once: the scenario loader, `--set`, `faba parts`, JSON Schema, the reference
/// pages and the bounds of identification are all read from this object. A field's default is not written
/// here: it is the value that it has in P{}.
template <class P>
class Schema {
 public:
  /// `name` is what `type = "..."` says; `summary` one sentence.
  Schema(std::string name, std::string summary) : name_(std::move(name)), summary_(std::move(summary)) {}

  template <class T>
  Schema& add(std::string key, T P::*member, FieldInfo info) {
    Field f;
    const Json fallback = schema_detail::dump(P{}.*member, info);
    f.description = {key, info, fallback, schema_detail::describe<T>(info, fallback)};
    f.set = [member, info](P& p, const Node& n) { p.*member = schema_detail::read<T>(n, info); };
    f.get = [member, info](const P& p) { return schema_detail::dump(p.*member, info); };
    fields_.push_back(std::move(f));
    return *this;
  }
  /// Takes over every field of a struct that P holds, as keys of the same table.
  template <class M>
  Schema& include(M P::*member, const Schema<M>& other) {
    for (const auto& theirs : other.fields_) {
      Field f;
      f.description = theirs.description;
      f.set = [member, set = theirs.set](P& p, const Node& n) { set(p.*member, n); };
      f.get = [member, get = theirs.get](const P& p) { return get(p.*member); };
      fields_.push_back(std::move(f));
    }
    for (const auto& rule : other.rules_)
      rules_.push_back([member, rule](const P& p) { return rule(p.*member); });
    return *this;
  }
  /// Named sets of defaults, chosen by the key `preset`; other keys given beside it win over it.
  Schema& preset(std::string preset_name, P values, std::string source) {
    presets_.push_back({std::move(preset_name), std::move(values), std::move(source)});
    return *this;
  }
  /// A check over several fields at once; returns what is wrong, or "".
  Schema& check(std::function<std::string(const P&)> rule) {
    rules_.push_back(std::move(rule));
    return *this;
  }
  /// Where the part is known to fail; shown by `faba parts` and the reference pages.
  Schema& validity(std::string text) {
    validity_ = std::move(text);
    return *this;
  }

  /// Reads and checks; unknown keys are errors. `extra` are keys that somebody else reads from the same
  /// table. Throws Error(usage) naming file, line, path, reason and the nearest known key.
  P parse(const Node& n, const std::vector<std::string>& extra = {}) const {
    if (!n.json->is_object()) n.fail("must be a table of parameters");
    P p = start(n);
    for (const auto& [key, value] : n.json->items()) {
      if (key == "preset" && !presets_.empty()) continue;
      if (std::find(extra.begin(), extra.end(), key) != extra.end()) continue;
      const Field* f = find(key);
      if (!f) throw Error(Errc::usage, n.where(key), "unknown key" + suggestion(key, known(extra)));
      f->set(p, n.child(key));
    }
    for (const auto& rule : rules_)
      if (const std::string wrong = rule(p); !wrong.empty()) n.fail(wrong);
    return p;
  }

  /// Every parameter with its value, defaults included: reading it back gives the same P.
  Json to_json(const P& p) const {
    Json j = Json::object();
    for (const auto& f : fields_)
      if (Json v = f.get(p); !v.is_null()) j[f.description.key] = std::move(v);
    return j;
  }

  Json json_schema() const {
    Json props = Json::object();
    for (const auto& f : fields_) props[f.description.key] = f.description.json_schema;
    Json j = {
        {"title", name_}, {"description", summary_}, {"type", "object"}, {"additionalProperties", false}};
    if (!presets_.empty()) {
      Json names = Json::array();
      Json sources = Json::object(), values = Json::object();
      for (const auto& p : presets_) {
        names.push_back(p.name);
        sources[p.name] = p.source;
        values[p.name] = to_json(p.values);
      }
      props["preset"] = {{"type", "string"},
                         {"enum", names},
                         {"x-source", sources},
                         {"x-values", values},
                         {"description", "Named set of values; keys given beside it win over it"}};
    }
    if (!validity_.empty()) j["x-validity"] = validity_;
    j["properties"] = props;
    return j;
  }
  const std::string& name() const { return name_; }
  const std::string& summary() const { return summary_; }
  /// Empty when nothing is said.
  const std::string& validity() const { return validity_; }

 private:
  template <class Other>
  friend class Schema;
  struct Field {
    FieldDescription description;
    std::function<void(P&, const Node&)> set;
    std::function<Json(const P&)> get;
  };
  struct Preset {
    std::string name;
    P values;
    std::string source;
  };
  P start(const Node& n) const {
    if (presets_.empty() || !n.has("preset")) return P{};
    const Node chosen = n.child("preset");
    std::vector<std::string> names;
    for (const auto& p : presets_) {
      if (*chosen.json == p.name) return p.values;
      names.push_back(p.name);
    }
    FieldInfo f;
    f.choices = names;
    schema_detail::read_choice(chosen, f);  // throws, listing the names
    return P{};
  }
  const Field* find(const std::string& key) const {
    for (const auto& f : fields_)
      if (f.description.key == key) return &f;
    return nullptr;
  }
  std::vector<std::string> known(std::vector<std::string> keys) const {
    for (const auto& f : fields_) keys.push_back(f.description.key);
    if (!presets_.empty()) keys.emplace_back("preset");
    return keys;
  }
  std::string name_, summary_, validity_;
  std::vector<Field> fields_;
  std::vector<Preset> presets_;
  std::vector<std::function<std::string(const P&)>> rules_;
};

}  // namespace faba
