#pragma once
#include <filesystem>

#include "study/identify/identify.h"

namespace faba {

/// Writes best.toml: a scene that repeats the first segment, or all of one drop, with the best model and its
/// parameters at the middle of what was found; and background.png, its light. For `faba run` and
/// `faba compare-controllers`. Throws Error(internal) when `dir` cannot be written.
void write_best_scene(const Identification& result, const std::filesystem::path& dir);

}  // namespace faba
