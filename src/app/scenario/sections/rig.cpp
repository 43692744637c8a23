#include "app/scenario/sections/rig.h"

namespace faba {

Json rig_json_schema(const Parts& parts) {
  Json j = RigSetup::json_schema();
  j["properties"]["camera"] = parts.camera.json_schema_of_choice();
  j["properties"]["driver"] = parts.driver.json_schema_of_choice();
  return j;
}

}  // namespace faba
