#pragma once
#include <fmt/format.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// A part that a scenario names, read and checked but not yet built.
template <class Interface, class Context>
struct Part {
  std::string type;
  Json resolved;  ///< `type` and every parameter, defaults included
  std::function<std::unique_ptr<Interface>(const Context&)> make;
};

/// Names -> factories for one kind of part. An ordinary value, not a global: the application owns it, tests
/// make their own. `Context` is what every part of the kind may look at when it is built (scale, field, grid
/// ...).
template <class Interface, class Context>
class Registry {
 public:
  using PartType = Part<Interface, Context>;

  /// `kind` is the word for messages ("agent model"), `doc` one sentence for `faba parts`.
  Registry(std::string kind, std::string doc) : kind_(std::move(kind)), doc_(std::move(doc)) {}

  /// T provides Params, static schema(), and a constructor T(Params, const Context&). Parameters that stand
  /// for something kept elsewhere, such as a file of measurements, are filled in by a static settle(Params&,
  /// const Node&), so that what is resolved stands by itself.
  template <class T>
  void add() {
    const auto s = T::schema();
    Entry e;
    e.json_schema = s.json_schema();
    e.resolve = [s](const Node& n) {
      typename T::Params p = s.parse(n, {"type"});
      if constexpr (requires { T::settle(p, n); }) T::settle(p, n);
      Json resolved = {{"type", s.name()}};
      resolved.update(s.to_json(p));
      return PartType{s.name(), std::move(resolved),
                      [p](const Context& c) { return std::make_unique<T>(p, c); }};
    };
    if (!entries_.emplace(s.name(), std::move(e)).second)
      throw Error(Errc::internal, kind_ + " " + s.name(), "registered twice");
  }

  /// Reads `{ type = "name", ... }`, or just "name" for a part with its defaults. Throws Error(usage).
  PartType resolve(const Node& n) const {
    Json table = n.json->is_string() ? Json{{"type", *n.json}} : *n.json;
    const Node node{table, n.path, n.document};
    if (!table.is_object() || !table.contains("type") || !table["type"].is_string())
      n.fail(fmt::format("needs type = \"...\"; known {}s: {}", kind_, fmt::join(names(), ", ")));
    const auto it = entries_.find(table["type"].get<std::string>());
    if (it == entries_.end())
      throw Error(Errc::usage, node.where("type"),
                  fmt::format("there is no {} \"{}\"{}", kind_, table["type"].get<std::string>(),
                              suggestion(table["type"].get<std::string>(), names())));
    return it->second.resolve(node);
  }

  std::vector<std::string> names() const {
    std::vector<std::string> v;
    for (const auto& [k, _] : entries_) v.push_back(k);
    return v;
  }
  /// JSON Schema of one part's parameters. The name must exist.
  const Json& json_schema(const std::string& name) const { return entries_.at(name).json_schema; }
  const std::string& kind() const { return kind_; }
  const std::string& doc() const { return doc_; }

 private:
  struct Entry {
    Json json_schema;
    std::function<PartType(const Node&)> resolve;
  };
  std::string kind_, doc_;
  std::map<std::string, Entry> entries_;
};

}  // namespace faba
