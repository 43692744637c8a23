#include "app/scenario/scenario_schema.h"

#include "app/scenario/read_event.h"

namespace faba {

Json scenario_json_schema(const Parts& parts) {
  Json j = Scenario::schema().json_schema();
  j["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  Json& p = j["properties"];
  p["scale"] = ScaleParams::schema().json_schema();
  p["scale"]["properties"]["file"] = {
      // include_calibration() puts um_per_px in its place
      {"type", "string"},
      {"description", "A calibration file of `faba scale`, in place of um_per_px"}};
  p["camera"] = CameraParams::schema().json_schema();
  p["microscope"] = MicroscopeParams::schema().json_schema();
  p["simulation"] = SimulationParams::schema().json_schema();
  p["exclusion"] = Exclusion::schema().json_schema();
  p["limits"] = Limits::schema().json_schema();
  p["record"] = Record::schema().json_schema();
  p["library"] = LibraryParams::schema().json_schema();
  Json swarm = Swarm::schema().json_schema(), rig = RigSetup::json_schema();
  each_kind(parts, [&](const char* kind, const auto& registry) {
    Json any = Json::array({Json{{"type", "string"}, {"enum", registry.names()}}});
    for (const auto& name : registry.names()) {
      Json one = registry.json_schema(name);
      one["properties"]["type"] = {{"const", name}};
      one["required"] = Json::array({"type"});
      if (name == "rig")  // include_rig() puts the file's content in its place
        one["properties"]["file"] = {{"type", "string"}, {"description", "A rig file, taken in as it is"}};
      any.push_back(one);
    }
    const Json choice = {{"description", registry.doc()}, {"oneOf", any}};
    const auto is = [&](const char* one, const char* other) {
      return std::string_view(kind) == one || std::string_view(kind) == other;
    };
    (is("model", "start")     ? swarm["properties"]
     : is("camera", "driver") ? rig["properties"]
                              : p)[kind] = choice;
  });
  p["rig"] = rig;
  p["swarm"] = {{"type", "array"}, {"minItems", 1}, {"items", swarm}};
  Json event = event_json_schema();
  for (const char* kind : {"estimator", "reference", "controller"}) event["properties"][kind] = p[kind];
  event["properties"]["model"] = swarm["properties"]["model"];
  p["event"] = {{"type", "array"}, {"items", event}};
  return j;
}

}  // namespace faba
