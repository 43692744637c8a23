#pragma once
#include <filesystem>

#include "app/scenario/scenario.h"

namespace faba {

/// Writes a PNG of a scene shortly after its start, drawn as in a recorded video. Runs a short simulation;
/// large swarms are reduced to 2000 cells. Throws Error(usage) when the parts of the scene are incompatible.
void write_scene_thumbnail(Scenario s, const std::filesystem::path& png);

/// Writes a PNG of a recorded run: a frame of its video at 2 s, or of its scene when it has no video.
void write_run_thumbnail(const std::filesystem::path& run, const std::filesystem::path& png);

}  // namespace faba
