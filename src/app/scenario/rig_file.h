#pragma once
#include <filesystem>

#include "app/scenario/parts.h"

namespace faba {

/// A rig in a TOML file of its own: [[coil]] and [earth]. Throws Error(usage) naming file, line and reason.
FieldRegistry::PartType read_rig(const std::filesystem::path& file, const Parts& parts);

/// JSON Schema of a rig file.
Json rig_file_json_schema(const Parts& parts);

/// What a resolved rig, or any other field, is told by: everything but names, where maps were read from, and
/// the currents that flow when nothing commands them.
std::string coil_system_hash(const Json& resolved);

/// Puts the content of the rig file named by the scenario's `field.file`, relative to the scenario or to
/// where the program was called, in the key's place, so that what is recorded stands by itself. What the
/// scenario says itself wins.
void include_rig(Document& scenario, const Parts& parts);

}  // namespace faba
