#include "app/scenario/sections/field.h"

#include <algorithm>

namespace faba {

Json field_json_schema(const Parts& parts) {
  Json j = parts.field.json_schema_of_choice();
  j["default"] = "uniform";
  const char* holds_coils = traits::kWords.at(std::size_t(Trait::coil_system));
  for (Json& one : j["oneOf"]) {
    if (!one.contains("x-traits")) continue;
    const Json& part_traits = one["x-traits"];
    if (std::find(part_traits.begin(), part_traits.end(), holds_coils) == part_traits.end()) continue;
    one["properties"]["file"] = {{"type", "string"},
                                 {"description", "Coil system file, whose content is included"}};
  }
  return j;
}

}  // namespace faba
