#pragma once
#include <filesystem>

#include "app/scenario/parts.h"
#include "core/toml.h"

namespace faba {

/// The answer to /api/check of web/protocol.md: the resolved scenario, the same as TOML, and notes. `root`:
/// folder of the runs. Throws Error(usage).
Json scenario_check(const Document& d, const Parts& parts, const std::filesystem::path& root);

}  // namespace faba
