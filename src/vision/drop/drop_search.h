#pragma once
#include <optional>
#include <string>
#include <vector>

#include "vision/drop/arc_evidence.h"
#include "vision/drop/circle_fit.h"
#include "vision/drop/drop_edge_options.h"
#include "vision/drop/drop_picture.h"
#include "vision/drop/edge_profile.h"

namespace faba {

/// A circle that was moved to where the picture shows its edge. Lengths in px of the picture, not of a copy.
struct DropCandidate {
  Circle circle;             ///< place of the edge: fit plus the middle of the grey profile across it
  CircleFit fit;             ///< to `points`, with standard deviations
  double arc_rad = 0;        ///< angle between the outermost points
  double seen_rad = 0;       ///< angle along which the edge is seen: arc_rad without long gaps
  std::vector<Vec2> points;  ///< sub-pixel edge points, along the arc
  ArcEvidence evidence;      ///< in px of the copy
  EdgeProfile profile;       ///< across the edge, in px of the copy
  double scale = 1;          ///< px of the picture per px of the copy
  std::string objection;     ///< why it is not accepted as a drop's edge; empty when it is
};

/// What a search came to.
struct DropSearch {
  std::optional<DropCandidate> accepted;  ///< the best of those without objection
  std::optional<DropCandidate> refused;   ///< the best of the others
  std::vector<EdgeSegment> segments;      ///< Hough segments along `accepted` in the copy that led to it
};

/// Looks for circular edges in the picture and its copies: pixels along Hough segments first, all edge pixels
/// when that leads to nothing, long straight segments last (to be able to say that the edge is straight).
DropSearch search_drop_edge(const DropPicture& picture, const DropEdgeOptions& options);

}  // namespace faba
