#pragma once
#include <filesystem>
#include <vector>

#include "app/scenario/parts.h"
#include "core/toml.h"

namespace faba {

/// The scenes of a gallery for the page, those of its index first and in its order; web/protocol.md,
/// /api/scenes. `files`: the scenes.
Json scene_cards(const std::filesystem::path& gallery, std::vector<std::filesystem::path> files,
                 const Parts& parts);
/// One scene as JSON and TOML; /api/scenes/NAME.
Json scene_answer(const std::filesystem::path& file, const Parts& parts);

}  // namespace faba
