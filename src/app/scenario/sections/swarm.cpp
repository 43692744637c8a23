#include "app/scenario/sections/swarm.h"

#include <fmt/format.h>

namespace faba {

Schema<Swarm::Params> Swarm::schema() {
  return Schema<Params>("swarm", "One kind of cells in the drop")
      .add("count", &Params::count,
           {.min = 1, .max = 5e7, .doc = "Number of cells", .title = "Number of cells"})
      .add("polarity", &Params::polarity,
           {.doc = "north: swims along the field; south: against it",
            .source = "the thesis's cells are south-seeking (A0)",
            .choices = {"north", "south"}})
      .add("responding", &Params::responding,
           {.min = 0,
            .max = 1,
            .doc = "Fraction of cells that respond to the field",
            .title = "Responsive fraction"})
      .add("heading", &Params::heading,
           {.unit = "rad",
            .min = -10,
            .max = 10,
            .doc = "Initial heading of cells that respond to the field, as after alignment by a field, "
                   "counter-clockwise with y up: 0 deg right, 90 deg up; default: random. The models basic "
                   "and adapted have no heading"});
}

std::vector<Swarm> read_swarms(const Node& root, const Parts& parts) {
  constexpr double kMostCells = 5e7;
  const Node list = root.child("swarm");
  if (!list.json->is_array() || list.json->empty())
    list.fail("must be an array of tables; write [[swarm]] for each kind of cells");
  std::vector<Swarm> swarms;
  double total = 0;
  const auto part = [](const Node& n, const char* key, const auto& registry, const Json& default_part) {
    return registry.resolve(n.has(key) ? n.child(key) : Node(default_part, key, n.document));
  };
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    Swarm swarm;
    swarm.params = Swarm::schema().parse(n, {"model", "start"});
    swarm.model = part(n, "model", parts.model, "dipole");
    swarm.start = part(n, "start", parts.start, "uniform");
    total += double(swarm.params.count);
    swarms.push_back(std::move(swarm));
  }
  if (total > kMostCells) list.fail(fmt::format("{} cells in total; the maximum is 5e7", total));
  return swarms;
}

Json swarms_json(const std::vector<Swarm>& swarms) {
  Json all = Json::array();
  for (const Swarm& s : swarms) {
    Json swarm = Swarm::schema().to_json(s.params);
    swarm["model"] = s.model.resolved;
    swarm["start"] = s.start.resolved;
    all.push_back(swarm);
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
