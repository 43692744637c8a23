#pragma once
#include <filesystem>

#include "app/scenario/parts.h"

namespace faba {

/// Reads a coil system file (TOML): [[coil]] and [earth]. Throws Error(usage) with file, line and reason.
FieldRegistry::PartType read_rig(const std::filesystem::path& file, const Parts& parts);

/// The same from a document in memory.
FieldRegistry::PartType read_rig(Document d, const Parts& parts);

/// JSON Schema of a coil system file.
Json rig_file_json_schema(const Parts& parts);

/// Hash of a resolved coil system or any other field, of all parameters except names, files of maps, and
/// default currents.
std::string coil_system_hash(const Json& resolved);

/// Replaces the key `field.file` of a scenario by the content of that coil system file (path relative to the
/// scenario or to the working directory), so that the recorded scenario is self-contained. Keys of the
/// scenario override those of the file.
void include_rig(Document& scenario, const Parts& parts);

}  // namespace faba
