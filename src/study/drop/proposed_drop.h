#pragma once
#include <optional>
#include <string>

#include "vision/drop/drop_edge.h"

namespace faba {

/// A circle to begin with where a drop's edge can be put right by hand.
struct ProposedDrop {
  bool found = false;            ///< whether it is the edge of a drop
  std::string why;               ///< not: the reason
  std::optional<DropEdge> edge;  ///< what was found: a drop's edge, or that of an air bubble in the liquid
  Vec2 centre_image;  ///< px, pixel centres at integers: of that edge, or of the picture when there is none
  double radius_px = 0;                   ///< of that edge, or 0.4 of the picture's smaller side
  int image_width = 0, image_height = 0;  ///< px
};

/// Finds the edge in a picture; `name` stands for it in the reason.
ProposedDrop propose_drop(const GrayF& picture, const std::string& name);

}  // namespace faba
