#pragma once
#include <optional>
#include <string>

#include "study/data/video_scale.h"
#include "vision/drop/drop_edge.h"

namespace faba {

/// Initial circle for the manual adjustment of the edge of a drop.
struct ProposedDrop {
  bool found = false;            ///< whether the edge of a drop was found
  std::string reason;            ///< reason when not found
  VideoScale scale;              ///< in the metadata of the picture
  std::optional<DropEdge> edge;  ///< edge of a drop, or of an air bubble in the liquid
  Vec2 centre_image;     ///< px, pixel centres at integers; of the edge, or of the picture without edge
  double radius_px = 0;  ///< of the edge, or 0.4 of the smaller side of the picture
  int image_width = 0, image_height = 0;  ///< px
};

/// Finds the edge in a picture; `name` is the name of the picture in messages.
ProposedDrop propose_drop(const GrayF& picture, const std::string& name);

}  // namespace faba
