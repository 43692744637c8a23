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

/// A circle refined to the edge in the picture. Lengths in px of the picture, not of a pyramid level.
struct DropCandidate {
  Circle circle;        ///< circle at the edge position: fit plus the position of the edge profile
  CircleFit fit;        ///< fit to `points`, with standard deviations
  double arc_rad = 0;   ///< angle between the outermost points
  double seen_rad = 0;  ///< angle along which the edge is detected: arc_rad without long gaps
  double out_of_round_px =
      0;                     ///< half the difference of the axes of an ellipse along the edge, if significant
  std::vector<Vec2> points;  ///< sub-pixel edge points, along the arc
  ArcEvidence evidence;      ///< in px of the level
  EdgeProfile profile;       ///< across the edge, in px of the level
  double scale = 1;          ///< px of the picture per px of the level
  std::string rejection;     ///< reason for rejection; empty: accepted
};

/// Result of search_drop_edge.
struct DropSearch {
  std::optional<DropCandidate> accepted;  ///< best accepted candidate
  std::optional<DropCandidate> rejected;  ///< best rejected candidate
  std::vector<EdgeSegment>
      segments;  ///< Hough segments along `accepted` in the pyramid level where it was found
};

/// Searches circular edges in all pyramid levels: first among pixels along Hough segments, then among all
/// edge pixels, last along long straight segments (to report a straight edge).
DropSearch search_drop_edge(const DropPicture& picture, const DropEdgeOptions& options);

}  // namespace faba
