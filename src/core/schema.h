#pragma once
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/toml.h"
#include "core/vec.h"

namespace faba {

/// Role of a parameter, for code that changes it without knowing the part; the key may have any name. The
/// JSON Schema has it as `x-role`, a word of kRoleWords.
enum class Role : std::size_t {
  none,
  position,  ///< coil: its centre, m, world frame
  axis,      ///< coil: direction of its field, of any length
  turn,      ///< coil: rotation about z, rad
  strength,  ///< coil: factor on its field
  ambient,   ///< coil system: field that the coils do not produce, T, world frame
  coupling,  ///< agent model: acts only as a factor of the field; observable as the turning rate of cells
  speed      ///< agent model: the number that sets how fast cells move; in forms with few inputs
};
/// Role in the JSON Schema of a parameter.
Role role_of(const Json& described);
inline constexpr std::array kRoleWords = {"",         "position", "axis",     "turn",
                                          "strength", "ambient",  "coupling", "speed"};

/// Description of one parameter. Numbers with a unit may be given as "186 um/s"; a bare number is in `unit`.
struct FieldInfo {
  std::string unit = {};                             ///< SI unit (or px); empty for a pure number
  double min = -std::numeric_limits<double>::max();  ///< in `unit`
  double max = std::numeric_limits<double>::max();
  std::string doc = {};                   ///< one sentence
  std::string source = {};                ///< source of the default; "assumed" if it was not measured
  std::vector<std::string> choices = {};  ///< allowed words, in the order of the enum
  std::string old_key = {};               ///< former name of the key, which is still read
  Role role = Role::none;
  /// Range in which `faba tune` searches, in `unit`, both positive; empty: it leaves the value as it is.
  std::vector<double> tuned = {};
  std::string title = {};  ///< name in forms, for a key that misleads; empty: forms make it from the key
  /// Argument of schema(context) for types whose schema depends on something, such as the registry of the
  /// parts that a table may name.
  std::shared_ptr<const void> context = {};
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
concept DescribedIn = requires(const void* context) {
  T::schema(context);
};

/// The schema of a struct that is a field of another.
template <class T>
auto nested(const FieldInfo& f) {
  if constexpr (DescribedIn<T>)
    return T::schema(f.context.get());
  else
    return T::schema();
}

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
    static_assert(Described<T> || DescribedIn<T>,
                  "the type of a parameter must be supported by the schema or have a schema()");
    return nested<T>(f).parse(n);
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
    return nested<T>(f).to_json(v);
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
    return nested<T>(f).json_schema();
  }
}

/// Operations of a schema on one type of value.
struct ValueType {
  void (*read)(void* to, const Node& n, const FieldInfo& f);
  Json (*dump)(const void* value, const FieldInfo& f);
  Json (*describe)(const FieldInfo& f, const Json& fallback);
};
template <class T>
inline constexpr ValueType kValueType = {
    [](void* to, const Node& n, const FieldInfo& f) { *static_cast<T*>(to) = read<T>(n, f); },
    [](const void* value, const FieldInfo& f) { return dump(*static_cast<const T*>(value), f); },
    [](const FieldInfo& f, const Json& fallback) { return describe<T>(f, fallback); }};

/// The fields of a struct with its type erased. Schema is implemented here once for all structs, which halves
/// the compile time of a part. A struct is the address of its first byte; a field has the offset `at` in
/// bytes.
class Fields {
 public:
  using Rule = std::function<std::string(const void*)>;

  Fields(std::string n, std::string s) : name(std::move(n)), summary(std::move(s)) {}
  void add(std::string key, std::size_t at, const ValueType& type, FieldInfo info, const void* defaults);
  void include(const Fields& other, std::size_t at);
  /// Index of the preset that a table names; empty if it names none. Throws Error(usage).
  std::optional<std::size_t> chosen_preset(const Node& n) const;
  /// Throws Error(usage).
  void read(void* to, const Node& n, const std::vector<std::string>& extra) const;
  Json to_json(const void* from) const;
  std::vector<std::string> notes(const void* of) const;
  /// `preset_values`: the structs of the presets, in their order.
  Json json_schema(const std::vector<const void*>& preset_values) const;

  std::string name, summary, validity;
  std::vector<std::pair<std::string, std::string>> presets;  ///< name and source
  std::vector<Rule> rules;                                   ///< messages are errors
  std::vector<Rule> advice;                                  ///< messages are notes

 private:
  struct Field {
    std::string key;
    FieldInfo info;
    std::size_t at;
    const ValueType* type;
    Json fallback;
  };
  const Field* find(const std::string& key) const;  ///< by its key or its old key
  std::vector<Field> fields_;
};
}  // namespace schema_detail

/// Value in SI of a number, or of a quantity with its unit as written by to_json().
double in_si(const Json& written);

/// "; did you mean "speed"?" if `word` is similar to one of `known`, otherwise the list of `known`.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Description of a plain struct P, used by the scenario loader, `--set`, `faba parts`, the JSON Schema, the
/// reference pages and the bounds of identification. The default of a field is its value in P{}.
template <class P>
class Schema {
 public:
  /// `name` is the value of `type = "..."`; `summary` is one sentence.
  Schema(std::string name, std::string summary) : fields_(std::move(name), std::move(summary)) {}

  template <class T>
  Schema& add(const std::string& key, T P::*member, const FieldInfo& info) {
    fields_.add(key, offset_of(member), schema_detail::kValueType<T>, info, &defaults_);
    return *this;
  }
  /// Adds every field of a struct that is a member of P, as keys of the same table.
  template <class M>
  Schema& include(M P::*member, const Schema<M>& other) {
    fields_.include(other.fields_, offset_of(member));
    return *this;
  }
  /// Named set of defaults, selected by the key `preset`; other keys of the table override it.
  Schema& preset(std::string preset_name, P values, std::string source) {
    fields_.presets.emplace_back(std::move(preset_name), std::move(source));
    presets_.push_back(std::move(values));
    return *this;
  }
  /// Adds a check of several fields: rule(const P&) returns the error message, or "".
  template <class Rule>
  Schema& check(Rule rule) {
    fields_.rules.emplace_back(
        [rule = std::move(rule)](const void* p) -> std::string { return rule(*static_cast<const P*>(p)); });
    return *this;
  }
  /// Adds a note on valid but probably unintended values: rule(const P&) returns its text, or "". The text
  /// gives the value, its consequence and an advice. A run prints the notes of its parts at its start.
  template <class Rule>
  Schema& note(Rule rule) {
    fields_.advice.emplace_back(
        [rule = std::move(rule)](const void* p) -> std::string { return rule(*static_cast<const P*>(p)); });
    return *this;
  }
  /// Conditions under which the part is known to fail, shown by `faba parts` and the reference pages.
  Schema& validity(std::string text) {
    fields_.validity = std::move(text);
    return *this;
  }

  /// Reads and checks; unknown keys are errors. `extra` are keys that other code reads from the same table.
  /// Throws Error(usage) with file, line, path, reason and the most similar known key.
  P parse(const Node& n, const std::vector<std::string>& extra = {}) const {
    const auto preset = fields_.chosen_preset(n);
    P p = preset ? presets_[*preset] : defaults_;
    fields_.read(&p, n, extra);
    return p;
  }
  /// All parameters with their values, including defaults; parsing the result gives the same P.
  Json to_json(const P& p) const { return fields_.to_json(&p); }
  /// The notes on these values.
  std::vector<std::string> notes(const P& p) const { return fields_.notes(&p); }
  Json json_schema() const {
    std::vector<const void*> values;
    for (const P& p : presets_) values.push_back(&p);
    return fields_.json_schema(values);
  }
  const std::string& name() const { return fields_.name; }
  const std::string& summary() const { return fields_.summary; }
  /// Empty if not set.
  const std::string& validity() const { return fields_.validity; }

 private:
  template <class Other>
  friend class Schema;
  template <class T>
  std::size_t offset_of(T P::*member) const {
    return std::size_t(reinterpret_cast<const char*>(&(defaults_.*member)) -
                       reinterpret_cast<const char*>(&defaults_));
  }
  schema_detail::Fields fields_;
  P defaults_{};
  std::vector<P> presets_;
};

}  // namespace faba
