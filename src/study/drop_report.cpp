#include "study/drop_report.h"

#include "vision/overlay.h"
#include "vision/picture.h"

namespace faba {

nlohmann::ordered_json drop_json(const DropEdge& e) {
  return {{"center_px", {e.centre_image.x, e.centre_image.y}},
          {"radius_px", e.radius_px},
          {"sd_px", {{"x", e.sd_centre_px.x}, {"y", e.sd_centre_px.y}, {"radius", e.sd_radius_px}}},
          {"arc_deg", e.arc_deg},
          {"inside", {e.inside_image.x, e.inside_image.y}},
          {"image_size", {e.image_width, e.image_height}}};
}

nlohmann::ordered_json report_drop(const std::filesystem::path& picture,
                                   const std::filesystem::path& overlay) {
  const GrayF grey = read_picture(picture).grey;
  DropEdgeOptions options;
  options.name = picture.string();
  const DropEdge edge = find_drop_edge(grey, options);
  if (!overlay.empty()) write_png(overlay, drop_overlay(grey, edge));
  return drop_json(edge);
}

}  // namespace faba
