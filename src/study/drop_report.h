#pragma once
#include <nlohmann/json_fwd.hpp>

#include "vision/drop_edge.h"

namespace faba {

/// The drop's edge as the command line and the web page report it:
/// `{"center_px":[x,y],"radius_px":r,"sd_px":{"x":..,"y":..,"radius":..},"arc_deg":..,"inside":[x,y],"image_size":[w,h]}`,
/// positions in picture px, y down as in the image file, `inside` a point of the picture inside the drop.
nlohmann::ordered_json drop_json(const DropEdge& edge);

}  // namespace faba
