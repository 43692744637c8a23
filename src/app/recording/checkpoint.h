#pragma once
#include <filesystem>
#include <string>

#include "core/archive.h"

namespace faba {

/// A checkpoint file: magic, length and checksum around an Archive's bytes, replaced as a whole.
/// `scenario_hash` ties it to its scenario.
void write_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash,
                      const Archive& content);

/// Throws Error(input) when it is missing, cut short, damaged, of another version, or of another scenario.
Archive read_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash);

}  // namespace faba
