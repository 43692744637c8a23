#include "app/files/from_picture.h"

#include <fmt/format.h>

#include "core/error.h"
#include "vision/drop/drop_edge.h"
#include "vision/files/picture.h"

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

}  // namespace faba
