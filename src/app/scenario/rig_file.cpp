#include "app/scenario/rig_file.h"
#include "app/scenario/file_kind.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/hash.h"

namespace faba {

FieldRegistry::PartType read_rig(const std::filesystem::path& file, const Parts& parts) {
  return read_rig(read_toml(file), parts);
}

FieldRegistry::PartType read_rig(Document d, const Parts& parts) {
  d.table_reader = parts.readers.table;
  require_kind(Node(d), FileKind::coil_system);
  if (!d.root.contains("coil"))
    throw Error(Errc::usage, d.name,
                "is not a coil system file: [[coil]] not found; see the examples in rigs/");
  d.root["type"] = parts.field.names_with(Trait::coil_system).front();
  return parts.field.resolve(Node(d));
}

namespace {

// Makes file names of a coil system file, which are relative to it, valid in a scenario.
void resolve_file_names(Document& rig) {
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
  // `file` of any other field type is a different file, such as a measured map.
  const std::vector<std::string> systems = parts.field.names_with(Trait::coil_system);
  const auto is_type = [&field](const std::string& name) { return field["type"] == name; };
  if (field.contains("type") && std::none_of(systems.begin(), systems.end(), is_type)) return;
  const Node node = Node(scenario).child("field").child("file");
  if (!field["file"].is_string()) node.fail("expected a string: the name of a coil system file");
  const std::string named = field["file"].get<std::string>();
  const std::filesystem::path file = node.file(named);
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    node.fail(
        fmt::format("{} not found, neither relative to the scenario nor to the working directory", named));
  Document rig = read_toml(file);
  resolve_file_names(rig);
  field.erase("file");
  for (const auto& [key, value] : rig.root.items()) {
    if (field.contains(key)) continue;
    field[key] = value;
    for (const auto& [path, location] : rig.origin)
      if (path.starts_with(key)) scenario.origin["field." + path] = location;
  }
}

}  // namespace faba
