#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/scenario/parts.h"

namespace faba {

struct Scenario;

/// One table of a scenario file, such as [camera]: how it is read, written and described.
/// Scenario::describe() has the list, which is used for reading, resolving, JSON Schema, hashing and the
/// reference pages.
struct Section {
  /// Tables and parts are independent of other sections; a composed section depends on those read before it.
  enum class Kind { table, part, composed };
  using Read = std::function<void(const Node& root, const Parts& parts, Scenario& s)>;

  std::string key;
  Kind kind = Kind::table;
  Read read;     ///< reads a section of the file; throws Error(usage)
  Read fill_in;  ///< for a file without the section; empty: the member keeps its defaults
  std::function<Json(const Scenario&)> resolved;  ///< null: no effect in this scenario
  std::function<Json(const Scenario&)> hashed;    ///< its part of the scenario hash; null: none
  std::function<Json(const Parts&)> json_schema;
  /// Whether it can be read with these parts: the engine without the program ignores the sections of devices.
  std::function<bool(const Parts&)> readable = [](const Parts&) { return true; };

  /// The section has an effect only under this condition.
  Section& when(bool (Scenario::*holds)() const) {
    resolved = only_when(holds, std::move(resolved));
    return hashed_when(holds);
  }
  /// The section is part of the scenario hash only under this condition.
  Section& hashed_when(bool (Scenario::*holds)() const) {
    hashed = only_when(holds, std::move(hashed));
    return *this;
  }
  /// The section affects only recording or execution of a run and is not part of the hash.
  Section& not_hashed() {
    hashed = [](const Scenario&) { return Json(); };
    return *this;
  }
  /// Adds a key to the schema that include_...() replaces before the section is read.
  Section& also_key(const std::string& name, const Json& described) {
    json_schema = [all = std::move(json_schema), name, described](const Parts& p) {
      Json j = all(p);
      j["properties"][name] = described;
      return j;
    };
    return *this;
  }

 private:
  using Value = std::function<Json(const Scenario&)>;
  static Value only_when(bool (Scenario::*holds)() const, Value all) {
    return [holds, all = std::move(all)](const Scenario& s) { return (s.*holds)() ? all(s) : Json(); };
  }
};

/// The list of sections, in the order of a resolved scenario.
class Sections {
 public:
  /// A table with a schema, stored in `member`.
  template <class P>
  Section& table(const char* key, P Scenario::*member, Schema<P> (*schema)()) {
    Section s;
    s.key = key;
    s.read = [=](const Node& root, const Parts&, Scenario& to) {
      const Node n = root.child(key);
      to.*member = schema().parse(n);
      if constexpr (requires(P & p) { P::settle(p, n); }) P::settle(to.*member, n);
    };
    s.resolved = [=](const Scenario& from) { return schema().to_json(from.*member); };
    s.json_schema = [=](const Parts&) { return schema().json_schema(); };
    return add(std::move(s));
  }

  /// A part of a kind, stored in `member`; `default_part` gives the part of a file that names none.
  template <class Registry>
  Section& part(const char* key, typename Registry::PartType Scenario::*member, Registry Parts::*kind,
                Json (Scenario::*default_part)() const) {
    Section s;
    s.key = key;
    s.kind = Section::Kind::part;
    s.readable = [=](const Parts& parts) { return !(parts.*kind).empty(); };
    s.read = [=](const Node& root, const Parts& parts, Scenario& to) {
      to.*member = (parts.*kind).resolve(root.child(key));
    };
    s.fill_in = [=](const Node& root, const Parts& parts, Scenario& to) {
      const Json name = (to.*default_part)();
      to.*member = (parts.*kind).resolve(Node(name, key, root.document));
    };
    s.resolved = [=](const Scenario& from) { return (from.*member).resolved; };
    s.json_schema = [=](const Parts& parts) { return (parts.*kind).json_schema_of_choice(); };
    return add(std::move(s));
  }
  /// The same with a default that does not depend on the scenario.
  template <class Registry>
  Section& part(const char* key, typename Registry::PartType Scenario::*member, Registry Parts::*kind,
                const Json& default_part) {
    Section& s = part(key, member, kind, static_cast<Json (Scenario::*)() const>(nullptr));
    s.fill_in = [=](const Node& root, const Parts& parts, Scenario& to) {
      to.*member = (parts.*kind).resolve(Node(default_part, key, root.document));
    };
    s.json_schema = [=](const Parts& parts) {
      Json j = (parts.*kind).json_schema_of_choice();
      j["default"] = default_part;
      return j;
    };
    return s;
  }

  /// A section with custom functions.
  Section& composed(const char* key, Section::Read read, std::function<Json(const Scenario&)> resolved,
                    std::function<Json(const Parts&)> json_schema) {
    Section s;
    s.key = key;
    s.kind = Section::Kind::composed;
    s.read = std::move(read);
    s.resolved = std::move(resolved);
    s.json_schema = std::move(json_schema);
    return add(std::move(s));
  }

  const std::vector<Section>& all() const { return all_; }

 private:
  Section& add(Section s) {
    s.hashed = s.resolved;
    return all_.emplace_back(std::move(s));
  }
  std::vector<Section> all_;
};

/// Every section of a scenario.
const std::vector<Section>& scenario_sections();

}  // namespace faba
