#include "app/scenario/scenario_schema.h"

#include "app/scenario/scenario.h"
#include "app/scenario/section.h"

namespace faba {

Json scenario_json_schema(const Parts& parts) {
  Json j = Scenario::schema().json_schema();
  j["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  for (const Section& section : scenario_sections())
    if (section.readable(parts)) j["properties"][section.key] = section.json_schema(parts);
  return j;
}

}  // namespace faba
