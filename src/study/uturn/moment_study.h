#pragma once
#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "study/uturn/moment.h"

namespace faba {

/// Reads a study file: `[cell]`, and `[[video]]` with file, field, reversals, fps. Throws Error(usage).
void read_moment_study(const std::filesystem::path& file, MomentJob& job);
/// JSON Schema of a study file.
nlohmann::ordered_json moment_study_schema();

}  // namespace faba
