#pragma once
#include <filesystem>

#include "app/scenario/scenario.h"

namespace faba {

/// Writes a PNG of how a scene looks a little after its beginning, as a recorded video would draw it. Takes a
/// moment; large swarms have fewer cells in it. Throws Error(usage) when its parts do not fit together.
void write_scene_thumbnail(Scenario s, const std::filesystem::path& png);

/// Writes a PNG of a recorded run: a frame from the first seconds of its video, or of its scene when it kept
/// none.
void write_run_thumbnail(const std::filesystem::path& run, const std::filesystem::path& png);

}  // namespace faba
