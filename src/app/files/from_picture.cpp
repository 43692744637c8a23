#include "app/files/from_picture.h"

#include <fmt/format.h>

#include <cmath>

#include "app/scenario/sections/scale.h"
#include "core/error.h"
#include "vision/drop/drop_edge.h"
#include "vision/files/picture.h"
#include "vision/files/picture_metadata.h"

namespace faba {

std::string fit_to_picture(Document& scenario, const std::filesystem::path& picture_or_video) {
  const Picture picture = read_picture(picture_or_video);
  DropEdgeOptions options;
  options.name = picture_or_video.string();
  const DropEdge edge = find_drop_edge(picture.grey, options);
  if (!edge.centre_side_inside)
    throw Error(
        Errc::input, options.name,
        "the picture shows an air bubble in liquid, not a drop: the cells are outside the circle; use a "
        "picture of a drop, or write the [arena] section manually");
  const std::string origin = "--from-video " + picture_or_video.string();
  scenario.set("arena",
               Json{{"type", "drop"},
                    {"view_px", {edge.image_width, edge.image_height}},
                    {"centre_px", {edge.centre_image.x, edge.centre_image.y}},
                    {"radius_px", edge.radius_px}},
               origin);
  std::string note =
      fmt::format("drop: centre ({:.0f}, {:.0f}) px, radius {:.0f} px, from {}", edge.centre_image.x,
                  edge.centre_image.y, edge.radius_px, picture_or_video.filename().string());
  if (!scenario.root.contains("swarm") || !scenario.root["swarm"].is_array())
    return note;  // read_scenario() reports the error
  for (std::size_t i = 0; i < scenario.root["swarm"].size(); ++i)
    if (scenario.root["swarm"][i].is_object() && !scenario.root["swarm"][i].contains("start"))
      scenario.set(fmt::format("swarm[{}].start", i), Json("visible"), origin);
  return note;
}

std::string take_scale(Document& scenario, const std::filesystem::path& picture_or_video) {
  constexpr double kSame = 0.01;  // relative difference of two scales
  const PictureMetadata stated = picture_metadata(picture_or_video);
  const std::string origin = "--from-video " + picture_or_video.string();
  const Json scale = scenario.root.value("scale", Json::object());
  if (!scale.is_object()) return {};  // read_scenario() reports the error
  if (scale.contains("file")) return {};
  if (const auto given = scale.find("um_per_px"); given != scale.end()) {
    if (!stated.um_per_px || !given->is_number()) return {};
    const double used = given->get<double>();
    if (std::fabs(*stated.um_per_px / used - 1) < kSame) return {};
    return fmt::format("scale: {} states {:.4g} um per px; the scenario's {:.4g} is used",
                       picture_or_video.filename().string(), *stated.um_per_px, used);
  }
  if (stated.um_per_px) {
    scenario.set("scale.um_per_px", Json(*stated.um_per_px), origin);
    scenario.set("scale.um_per_px_source", Json("metadata"), origin);
    return {};
  }
  if (!scale.contains("nominal_um_per_px"))
    scenario.set("scale.nominal_um_per_px", Json(kNominalUmPerPx), origin);
  return stated.ignored;
}

}  // namespace faba
