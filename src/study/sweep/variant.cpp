#include "study/sweep/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.h"

namespace faba {

std::vector<Variant> read_variants(const Node& study, const std::string& key,
                                   const std::vector<std::string>& extra) {
  std::vector<Variant> variants;
  if (!study.has(key)) return {{.name = "as the scene has it", .origin = study.where()}};
  const Node list = study.child(key);
  if (!list.json->is_array() || list.json->empty())
    list.fail(fmt::format("must be one or more tables [[{}]]", key));
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    if (!n.json->is_object()) n.fail(fmt::format("must be a table, [[{}]]", key));
    Variant v{.part = Json::object(), .origin = n.where()};
    for (const auto& [word, value] : n.json->items()) {
      const bool is_extra = std::find(extra.begin(), extra.end(), word) != extra.end();
      if (is_extra)
        v.extra[word] = value;
      else if (word == "name") {
        if (!value.is_string() || value.get<std::string>().empty()) n.child(word).fail("must be a string");
        v.name = value.get<std::string>();
      } else if (word == "set") {
        if (!value.is_object()) n.child(word).fail("must be a table of paths and values");
        for (const auto& [path, to] : value.items()) v.set.emplace_back(path, to);
      } else {
        v.part[word] = value;
      }
    }
    if (v.part.empty())
      v.part = Json();
    else if (!v.part.contains("type") || !v.part["type"].is_string())
      n.fail("key \"type\" is missing; specify type = \"...\"");
    if (v.name.empty())
      v.name = v.part.is_null() ? fmt::format("{} {}", key, i + 1) : v.part["type"].get<std::string>();
    if (!names.insert(v.name).second)
      n.fail(fmt::format("the name \"{}\" is used twice; names must be unique", v.name));
    variants.push_back(std::move(v));
  }
  return variants;
}

Json variant_schema(const std::string& description) {
  return {{"title", "variant"},
          {"description", description},
          {"type", "object"},
          {"properties",
           {{"name", {{"type", "string"}, {"description", "Name in reports; default: the type"}}},
            {"type",
             {{"type", "string"},
              {"description",
               "Type of the part, whose parameters follow as further keys; default: the part of the scene"}}},
            {"set",
             {{"type", "object"}, {"description", "Other values of the scenario to override, by path"}}}}}};
}

void apply(const Variant& v, const std::string& place, Document& d) {
  if (!v.part.is_null()) {
    if (place == "model") {
      const std::size_t swarms =
          d.root.contains("swarm") && d.root["swarm"].is_array() ? d.root["swarm"].size() : 0;
      for (std::size_t i = 0; i < swarms; ++i) d.set(fmt::format("swarm[{}].model", i), v.part, v.origin);
    } else {
      d.set(place, v.part, v.origin);
    }
  }
  for (const auto& [path, value] : v.set) d.set(path, value, v.origin + ".set");
}

}  // namespace faba
