#include "app/scenario/rig_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/hash.h"

namespace faba {

FieldRegistry::PartType read_rig(const std::filesystem::path& file, const Parts& parts) {
  Document d = read_toml(file);
  d.table_reader = parts.readers.table;
  if (!d.root.contains("coil"))
    throw Error(Errc::usage, file.string(), "is no rig: it has no [[coil]]; see rigs/ for some");
  d.root["type"] = parts.field.names_with(Trait::coil_system).front();
  return parts.field.resolve(Node(d));
}

namespace {

// Files that a rig names stand beside it; in a scenario the same names would be looked for elsewhere.
void files_from_here(Document& rig) {
  if (!rig.root.contains("coil") || !rig.root["coil"].is_array()) return;
  for (Json& coil : rig.root["coil"]) {
    if (!coil.is_object() || !coil.contains("file") || !coil["file"].is_string()) continue;
    coil["file"] = Node(rig).file(coil["file"].get<std::string>()).string();
  }
}

}  // namespace

Json rig_file_json_schema(const Parts& parts) {
  Json j = parts.field.json_schema(parts.field.names_with(Trait::coil_system).front());
  j["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  j["required"] = Json::array({"coil"});
  return j;
}

std::string coil_system_hash(const Json& resolved) {
  Json rig = resolved;
  const auto strip = [](Json& coil) {
    for (const char* key : {"name", "current", "file"}) coil.erase(key);
  };
  strip(rig);
  if (rig.contains("coil") && rig["coil"].is_array())
    for (Json& coil : rig["coil"]) strip(coil);
  Hash h;
  h.text(rig.dump());
  return h.hex();
}

void include_rig(Document& scenario, const Parts& parts) {
  if (!scenario.root.is_object() || !scenario.root.contains("field") || !scenario.root["field"].is_object())
    return;
  Json& field = scenario.root["field"];
  if (!field.contains("file")) return;
  // A part of another kind reads a file of its own, such as a measured map.
  const std::vector<std::string> systems = parts.field.names_with(Trait::coil_system);
  if (field.contains("type") && std::find(systems.begin(), systems.end(), field["type"]) == systems.end())
    return;
  const Node node = Node(scenario).child("field").child("file");
  if (!field["file"].is_string()) node.fail("expected the name of a rig file in quotes");
  const std::string named = field["file"].get<std::string>();
  const std::filesystem::path file = node.file(named);
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    node.fail(
        fmt::format("there is no {}, neither beside the scenario nor where the program was called", named));
  Document rig = read_toml(file);
  files_from_here(rig);
  field.erase("file");
  for (const auto& [key, value] : rig.root.items()) {
    if (field.contains(key)) continue;
    field[key] = value;
    for (const auto& [path, place] : rig.origin)
      if (path.starts_with(key)) scenario.origin["field." + path] = place;
  }
}

}  // namespace faba
