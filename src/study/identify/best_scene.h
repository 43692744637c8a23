#pragma once
#include <filesystem>

#include "study/identify/identify.h"

namespace faba {

/// Writes best.toml, a scene of the first episode with the best model at the posterior medians of its
/// parameters, and background.png, its background illumination. For `faba run` and
/// `faba compare-controllers`. Throws Error(internal) when `dir` cannot be written.
void write_best_scene(const Identification& result, const std::filesystem::path& dir);

}  // namespace faba
