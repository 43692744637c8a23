#pragma once
#include <array>
#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "study/drop/proposed_drop.h"

namespace faba {

/// The drop edge as reported by the command line and the web page:
/// `{"center_px":[x,y],"radius_px":r,"sd_px":{"x":..,"y":..,"radius":..},"arc_deg":..,"inside":[x,y],"image_size":[w,h]}`,
/// Positions in picture px, y down as in the image file; `inside` is a point of the picture inside the drop.
/// `um_per_px` and `um_per_px_source` are null if the scale is not known.
nlohmann::ordered_json drop_json(const DropEdge& edge, const VideoScale& scale);

/// A proposed drop for the web page of the lab: the fields of the edge and `"found"`, and
/// `"reason"` when a bubble was found; without an edge `"found": false, "reason", "center_px", "radius_px",
/// "image_size"`, and the scale.
nlohmann::ordered_json drop_json(const ProposedDrop& drop);

/// Detects the drop edge in a picture or in the first frame of a video. Unless `overlay` is empty, writes the
/// picture with the edge drawn in. Unless `stages` is empty, writes pictures of the stages of the detection
/// into that folder; those before the detection of an edge also when it fails. Throws Error(input) when the
/// picture is not usable or has no edge.
DropEdge report_drop(const std::filesystem::path& picture, const std::filesystem::path& overlay,
                     const std::filesystem::path& stages);

/// Calls propose_drop() and writes the contrast-stretched picture as PNG to `shown`. `name`: name of the
/// picture in messages. Throws Error(input) when the picture is not usable.
ProposedDrop report_proposed_drop(const std::filesystem::path& picture, const std::string& name,
                                  const std::filesystem::path& shown);

/// Writes a picture, or the first frame of a video, as PNG for display, contrast-stretched unless it has
/// colours. Throws Error(input) when the picture is not usable.
void write_displayed_picture(const std::filesystem::path& picture, const std::filesystem::path& png);

/// File names of the stages, in order.
inline constexpr std::array kDropStages{"1-grey.png", "2-edges.png", "3-lines.png", "4-circle.png"};

}  // namespace faba
