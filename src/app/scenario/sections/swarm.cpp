#include "app/scenario/sections/swarm.h"

#include <fmt/format.h>

namespace faba {

Schema<Swarm::Params> Swarm::schema() {
  return Schema<Params>("swarm", "One kind of cell among those in the drop")
      .add("count", &Params::count, {.min = 1, .max = 5e7, .doc = "Number of cells"})
      .add("polarity", &Params::polarity,
           {.doc = "north: swims along the field; south: against it",
            .source = "the thesis's cells are south-seeking (A0)",
            .choices = {"north", "south"}})
      .add("responding", &Params::responding,
           {.min = 0, .max = 1, .doc = "Fraction of the cells that feel the field"})
      .add("heading", &Params::heading,
           {.unit = "rad",
            .min = -1000,
            .max = 1000,
            .doc = "Where cells that feel the field head at first, as those that a field has held: 0 deg "
                   "right, 90 "
                   "deg up; any way when absent. basic and adapted have no heading"});
}

std::vector<Swarm> read_swarms(const Node& root, const Parts& parts) {
  constexpr double kMostCells = 5e7;
  const Node list = root.child("swarm");
  if (!list.json->is_array() || list.json->empty()) list.fail("write [[swarm]], once for each kind of cell");
  std::vector<Swarm> swarms;
  double total = 0;
  const auto part = [](const Node& n, const char* key, const auto& registry, const Json& usual) {
    return registry.resolve(n.has(key) ? n.child(key) : Node(usual, key, n.document));
  };
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    Swarm one;
    one.params = Swarm::schema().parse(n, {"model", "start"});
    one.model = part(n, "model", parts.model, "dipole");
    one.start = part(n, "start", parts.start, "uniform");
    total += double(one.params.count);
    swarms.push_back(std::move(one));
  }
  if (total > kMostCells) list.fail(fmt::format("{} cells in all; at most 5e7 are possible", total));
  return swarms;
}

Json swarms_json(const std::vector<Swarm>& swarms) {
  Json all = Json::array();
  for (const Swarm& s : swarms) {
    Json one = Swarm::schema().to_json(s.params);
    one["model"] = s.model.resolved;
    one["start"] = s.start.resolved;
    all.push_back(one);
  }
  return all;
}

Json swarms_json_schema(const Parts& parts) {
  Json one = Swarm::schema().json_schema();
  one["properties"]["model"] = parts.model.json_schema_of_choice();
  one["properties"]["model"]["default"] = "dipole";
  one["properties"]["start"] = parts.start.json_schema_of_choice();
  one["properties"]["start"]["default"] = "uniform";
  return {{"type", "array"}, {"minItems", 1}, {"items", one}};
}

}  // namespace faba
