#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/schema.h"
#include "core/traits.h"

namespace faba {

/// A part named in a scenario, read and checked but not yet constructed.
template <class Interface, class Context>
struct Part {
  std::string type;
  std::vector<Trait> traits;
  Json resolved;  ///< `type` and every parameter, defaults included
  std::function<std::unique_ptr<Interface>(const Context&)> make;
  std::vector<std::string> notes = {};  ///< on valid but probably unintended values (Schema::note)

  bool has(Trait t) const { return std::find(traits.begin(), traits.end(), t) != traits.end(); }
};

/// Factories of one kind of part, by name. An ordinary value, not a global: the application owns it, tests
/// create others. `Context` holds what the parts of the kind need for construction (scale, field, grid ...).
template <class Interface, class Context>
class Registry {
 public:
  using PartType = Part<Interface, Context>;

  /// `kind` is the name of the kind in messages ("model"), `doc` one sentence for `faba parts`.
  Registry(std::string kind, std::string doc) : kind_(std::move(kind)), doc_(std::move(doc)) {}

  /// T provides Params, static schema(), and a constructor T(Params, const Context&). An optional static
  /// settle(Params&, const Node&) replaces references to other files, such as a file of measurements, by
  /// their content, so that the resolved parameters are self-contained.
  template <class T>
  void add() {
    add<T>(T::schema());
  }
  /// The same with a schema that depends on other parts.
  template <class T>
  void add(const Schema<typename T::Params>& s) {
    using Params = typename T::Params;
    add_made<Params>(
        s, traits::of<T>(), [](const Params& p, const Context& c) { return std::make_unique<T>(p, c); },
        [](Params& p, const Node& n) {
          if constexpr (requires { T::settle(p, n); }) T::settle(p, n);
        });
  }
  /// A part that a function makes, for a class that is not known at compile time. `settle`: see add().
  template <class P>
  void add_made(
      const Schema<P>& s, const std::vector<Trait>& its_traits,
      const std::function<std::unique_ptr<Interface>(const P&, const Context&)>& make,
      const std::function<void(P&, const Node&)>& settle = [](P&, const Node&) {}) {
    const auto schema = std::make_shared<const Schema<P>>(s);
    Entry e;
    e.traits = its_traits;
    e.json_schema = [schema, its_traits] {
      Json j = schema->json_schema();
      j["x-traits"] = Json::array();
      for (const Trait t : its_traits) j["x-traits"].push_back(traits::kWords.at(std::size_t(t)));
      return j;
    };
    e.resolve = [schema, its_traits, make, settle](const Node& n) {
      P p = schema->parse(n, {"type"});
      settle(p, n);
      Json resolved = {{"type", schema->name()}};
      resolved.update(schema->to_json(p));
      std::vector<Trait> its = its_traits;  // and those of the parts that it contains
      if constexpr (requires { p.traits(); })
        for (const Trait t : p.traits()) its.push_back(t);
      return PartType{schema->name(), std::move(its), std::move(resolved),
                      [p, make](const Context& c) { return make(p, c); }, schema->notes(p)};
    };
    if (!entries_.emplace(s.name(), std::move(e)).second)
      throw Error(Errc::internal, kind_ + " " + s.name(), "registered twice");
  }
  /// A part that only another program has: a file that names it gives Error(usage) with `advice`, unless a
  /// part of this name is added.
  void elsewhere(const std::string& name, std::string advice) { elsewhere_[name] = std::move(advice); }

  /// Registry of the parts with a trait, under another name of the kind.
  Registry only(Trait t, std::string kind, std::string doc) const {
    Registry some(std::move(kind), std::move(doc));
    for (const auto& [name, e] : entries_)
      if (std::find(e.traits.begin(), e.traits.end(), t) != e.traits.end()) some.entries_.emplace(name, e);
    return some;
  }

  /// Reads `{ type = "name", ... }`, or just "name" for a part with its defaults. Throws Error(usage).
  PartType resolve(const Node& n) const {
    Json table = n.json->is_string() ? Json{{"type", *n.json}} : *n.json;
    const Node node{table, n.path, n.document};
    if (!table.is_object() || !table.contains("type") || !table["type"].is_string()) {
      if (table.is_object() && !table.contains("type")) fail_if_set(node);
      n.fail(fmt::format("key \"type\" is missing; known {}s: {}", kind_, fmt::join(names(), ", ")));
    }
    const auto type = table["type"].get<std::string>();
    if (const auto it = entries_.find(type); it != entries_.end()) return it->second.resolve(node);
    if (const auto it = elsewhere_.find(type); it != elsewhere_.end())
      throw Error(Errc::usage, node.where(), it->second);
    throw Error(Errc::usage, node.where("type"),
                fmt::format("unknown {} \"{}\"{}", kind_, type, suggestion(type, names())));
  }

  bool empty() const { return entries_.empty(); }
  std::vector<std::string> names() const {
    std::vector<std::string> v;
    for (const auto& [k, _] : entries_) v.push_back(k);
    return v;
  }
  /// Names of the parts with a trait.
  std::vector<std::string> names_with(Trait t) const { return only(t, "", "").names(); }
  /// Names of the parts that have none of these traits, for proposals in messages.
  std::vector<std::string> names_without(std::initializer_list<Trait> unwanted) const {
    std::vector<std::string> v;
    for (const auto& [name, e] : entries_)
      if (std::find_first_of(e.traits.begin(), e.traits.end(), unwanted.begin(), unwanted.end()) ==
          e.traits.end())
        v.push_back(name);
    return v;
  }
  /// JSON Schema of one part's parameters. The name must exist.
  Json json_schema(const std::string& name) const { return entries_.at(name).json_schema(); }
  /// JSON Schema of a table whose `type` is the name of any of the parts.
  Json json_schema_of_any() const {
    Json any = Json::array();
    for (const auto& [name, e] : entries_) {
      Json one = e.json_schema();
      one["properties"]["type"] = {{"const", name}};
      one["required"] = Json::array({"type"});
      any.push_back(one);
    }
    return {{"oneOf", any}};
  }
  /// The same, or a string: the name of a part with its defaults.
  Json json_schema_of_choice() const {
    Json any = Json::array({Json{{"type", "string"}, {"enum", names()}}});
    const Json tables = json_schema_of_any();
    for (const Json& one : tables.at("oneOf")) any.push_back(one);
    return {{"description", doc_}, {"oneOf", any}};
  }
  const std::string& kind() const { return kind_; }
  const std::string& doc() const { return doc_; }

 private:
  // A table without a type that the option --set created.
  void fail_if_set(const Node& n) const {
    if (!n.document) return;
    const auto it = n.document->origin.find(n.path);
    if (it == n.document->origin.end() || it->second != "--set") return;
    std::string values;
    for (const auto& [key, value] : n.json->items()) values += fmt::format(", {}={}", key, value.dump());
    n.fail(
        fmt::format("key \"type\" is missing, which a table created by --set needs; write --set "
                    "'{}={{type=\"NAME\"{}}}' with the type of "
                    "the {}: {}",
                    n.path, values, kind_, fmt::join(names(), ", ")));
  }

  struct Entry {
    std::vector<Trait> traits;
    std::function<Json()> json_schema;  ///< made when it is needed: most runs need none
    std::function<PartType(const Node&)> resolve;
  };
  std::string kind_, doc_;
  std::map<std::string, Entry> entries_;
  std::map<std::string, std::string> elsewhere_;  ///< advice, by name
};

}  // namespace faba
