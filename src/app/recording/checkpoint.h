#pragma once
#include <filesystem>
#include <string>

#include "core/archive.h"

namespace faba {

/// Writes a checkpoint file: magic, checksum, `scenario_hash` and the bytes of an Archive. An existing file
/// is replaced atomically. `scenario_hash` identifies the scenario.
void write_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash,
                      const Archive& content);

/// Throws Error(input) if it is missing, truncated, corrupt, of another version, or of another scenario.
Archive read_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash);

}  // namespace faba
