#pragma once
#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "study/motion/activity.h"

namespace faba {

/// Reads a study file: `[[video]]` with file, exposure, experiment, direction, from, to; and defaults for all
/// videos: direction, from, to, threshold, noise, [flow]. An experiment file is a study of all its videos;
/// each drop is an experiment of the lines against exposure. Throws Error(usage).
void read_activity_study(const std::filesystem::path& file, ActivityJob& job);
/// JSON Schema of a study file.
nlohmann::ordered_json activity_study_schema();

}  // namespace faba
