#include "study/pages/drop_report.h"

#include <algorithm>

#include "core/error.h"
#include "vision/draw/overlay.h"
#include "vision/files/picture.h"

#include <nlohmann/json.hpp>

namespace faba {

nlohmann::ordered_json drop_json(const DropEdge& edge) {
  nlohmann::ordered_json json;
  json["center_px"] = {edge.centre_image.x, edge.centre_image.y};
  json["radius_px"] = edge.radius_px;
  json["sd_px"]["x"] = edge.sd_centre_px.x;
  json["sd_px"]["y"] = edge.sd_centre_px.y;
  json["sd_px"]["radius"] = edge.sd_radius_px;
  json["arc_deg"] = edge.arc_deg;
  json["inside"] = {edge.inside_image.x, edge.inside_image.y};
  json["image_size"] = {edge.image_width, edge.image_height};
  return json;
}

nlohmann::ordered_json report_drop(const std::filesystem::path& picture, const std::filesystem::path& overlay,
                                   const std::filesystem::path& stages) {
  const GrayF grey = read_picture(picture).grey;
  DropEdgeOptions options;
  options.name = picture.string();
  if (!stages.empty()) {
    const Gray8 edges = edge_pixel_picture(grey, options);
    std::filesystem::create_directories(stages);
    write_png(stages / kDropStages[0], stretched(grey, options.stretch_low, options.stretch_high));
    write_png(stages / kDropStages[1], edges);
  }
  const DropEdge edge = find_drop_edge(grey, options);
  if (!stages.empty()) {
    write_png(stages / kDropStages[2], hough_picture(grey, edge));
    write_png(stages / kDropStages[3], drop_overlay(grey, edge));
  }
  if (!overlay.empty()) write_png(overlay, drop_overlay(grey, edge));
  return drop_json(edge);
}

nlohmann::ordered_json propose_drop(const std::filesystem::path& picture, const std::string& name,
                                    const std::filesystem::path& shown) {
  const GrayF grey = read_picture(picture).grey;
  write_png(shown, stretched(grey));
  DropEdgeOptions options;
  options.name = name;
  nlohmann::ordered_json json;
  try {
    const DropEdge edge = find_drop_edge(grey, options);
    json = drop_json(edge);
    json["found"] = edge.centre_side_inside;
    if (!edge.centre_side_inside) json["why"] = "shows an air bubble in the liquid, not a drop";
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;
    constexpr double kRadius = 0.4;  // of the smaller side
    const double w = grey.width, h = grey.height;
    json = {{"found", false},
            {"why", e.reason()},
            {"center_px", {(w - 1) / 2, (h - 1) / 2}},
            {"radius_px", kRadius * std::min(w, h)},
            {"image_size", {grey.width, grey.height}}};
  }
  return json;
}

}  // namespace faba
