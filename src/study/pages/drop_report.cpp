#include "study/pages/drop_report.h"

#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/drop/drop_warnings.h"
#include "study/pages/quality_output.h"
#include "vision/draw/overlay.h"
#include "vision/files/picture.h"

namespace faba {

nlohmann::ordered_json drop_json(const DropEdge& edge, const VideoScale& scale) {
  nlohmann::ordered_json json;
  json["center_px"] = {edge.centre_image.x, edge.centre_image.y};
  json["radius_px"] = edge.radius_px;
  json["sd_px"]["x"] = edge.sd_centre_px.x;
  json["sd_px"]["y"] = edge.sd_centre_px.y;
  json["sd_px"]["radius"] = edge.sd_radius_px;
  json["arc_deg"] = edge.arc_deg;
  json["support"] = edge.support;
  json["edge_width_px"] = edge.edge_width_px;
  json["out_of_round_px"] = edge.out_of_round_px;
  json["inside"] = {edge.inside_image.x, edge.inside_image.y};
  json["image_size"] = {edge.image_width, edge.image_height};
  add_scale(json, scale);
  add_quality(json, drop_warnings(edge));
  return json;
}

nlohmann::ordered_json drop_json(const ProposedDrop& drop) {
  if (!drop.edge) {
    Json json = {{"found", false},
                 {"reason", drop.reason},
                 {"center_px", {drop.centre_image.x, drop.centre_image.y}},
                 {"radius_px", drop.radius_px},
                 {"image_size", {drop.image_width, drop.image_height}}};
    add_scale(json, drop.scale);
    return json;
  }
  Json json = drop_json(*drop.edge, drop.scale);
  json["found"] = drop.found;
  if (!drop.found) json["reason"] = drop.reason;
  return json;
}

DropEdge report_drop(const std::filesystem::path& picture, const std::filesystem::path& overlay,
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
  DropEdge edge = find_drop_edge(grey, options);
  if (!stages.empty()) {
    write_png(stages / kDropStages[2], hough_picture(displayed(grey), edge));
    write_png(stages / kDropStages[3], drop_overlay(displayed(grey), edge));
  }
  if (!overlay.empty()) write_png(overlay, drop_overlay(read_displayed(picture), edge));
  return edge;
}

ProposedDrop report_proposed_drop(const std::filesystem::path& picture, const std::string& name,
                                  const std::filesystem::path& shown) {
  const GrayF grey = read_picture(picture).grey;
  write_png(shown, read_displayed(picture));
  ProposedDrop drop = propose_drop(grey, name);
  drop.scale = scale_of_file(picture);
  return drop;
}

void write_displayed_picture(const std::filesystem::path& picture, const std::filesystem::path& png) {
  write_png(png, read_displayed(picture));
}

}  // namespace faba
