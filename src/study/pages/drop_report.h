#pragma once
#include <array>
#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "study/drop/proposed_drop.h"

namespace faba {

/// The drop's edge as the command line and the web page report it:
/// `{"center_px":[x,y],"radius_px":r,"sd_px":{"x":..,"y":..,"radius":..},"arc_deg":..,"inside":[x,y],"image_size":[w,h]}`,
/// positions in picture px, y down as in the image file, `inside` a point of the picture inside the drop.
nlohmann::ordered_json drop_json(const DropEdge& edge);

/// A drop to begin with as the lab's page takes it: drop_json() and `"found"`, and `"why"` when what was
/// found is a bubble; or, when there is no edge, `"found": false, "why", "center_px", "radius_px",
/// "image_size"`.
nlohmann::ordered_json drop_json(const ProposedDrop& drop);

/// Finds the edge in a picture or in the first frame of a video and, unless `overlay` is empty, writes the
/// picture with the edge drawn in; unless `stages` is empty, pictures of each stage of the search into that
/// folder (those before an edge was found also when none is). Throws Error(input) when there is no usable
/// picture or no edge in it.
DropEdge report_drop(const std::filesystem::path& picture, const std::filesystem::path& overlay,
                     const std::filesystem::path& stages);

/// propose_drop for a page: writes the picture as PNG for the eye to `shown`. `name` stands for the picture
/// in messages. Throws Error(input) when there is no usable picture.
ProposedDrop report_proposed_drop(const std::filesystem::path& picture, const std::string& name,
                                  const std::filesystem::path& shown);

/// The pictures in a folder of stages, in their order.
inline constexpr std::array kDropStages{"1-grey.png", "2-edges.png", "3-lines.png", "4-circle.png"};

}  // namespace faba
