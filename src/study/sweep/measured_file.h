#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "core/archive.h"

namespace faba {

/// The measurement of an input of a study, stored under a key that depends on the content of the input and on
/// all settings of the measurement. Empty when it is not stored or the file is damaged: it can be measured
/// again. `folder` may be empty.
std::optional<Archive> read_measured(const std::filesystem::path& folder, const std::string& key);

/// Stores a measurement; does nothing if `folder` is empty. Throws Error(internal).
void write_measured(const std::filesystem::path& folder, const std::string& key, const Archive& content);

}  // namespace faba
