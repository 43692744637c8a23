#pragma once
#include <filesystem>

#include <nlohmann/json.hpp>

#include "vision/drop_edge.h"

namespace faba {

/// The edge as `faba drop --json` prints it: `center_px`, `radius_px`, `sd_px`, `arc_deg`, `inside`,
/// `image_size`; picture px, y down.
nlohmann::ordered_json drop_json(const DropEdge& edge);

/// Finds the edge in a picture or in the first frame of a video and, unless `overlay` is empty, writes the
/// picture with the edge drawn in. Throws Error(input) when there is no usable picture or no edge in it.
nlohmann::ordered_json report_drop(const std::filesystem::path& picture,
                                   const std::filesystem::path& overlay);

}  // namespace faba
