#pragma once
#include <vector>

#include "core/vec.h"
#include "vision/drop/drop_edge_options.h"
#include "vision/image/image.h"

namespace faba {

/// The edge of a drop: a circle and how sure it is. Image frame: x right, y down, px, pixel centres at
/// integers.
struct DropEdge {
  Vec2 centre_image;  ///< may lie far outside the picture
  double radius_px = 0;
  Vec2 sd_centre_px;  ///< standard deviations, from the scatter of the edge about the circle
  double sd_radius_px = 0;
  double arc_deg = 0;              ///< angle the supporting arc covers as seen from the centre, 0..360
  Vec2 inside_image;               ///< a point of the picture that is inside the drop
  bool centre_side_inside = true;  ///< whether the drop is the side that holds the centre
  int image_width = 0, image_height = 0;
  double contrast = 0;       ///< grey inside minus outside of a step, middle minus sides of a line
  double edge_width_px = 0;  ///< Gaussian sd of the blurred step or line
  double support = 0;        ///< share of the circle's arc in the picture along which the edge was seen, 0..1
  double log10_false_alarms = 0;      ///< how often chance would give such a circle; see ArcEvidence
  std::vector<Vec2> edge_points;      ///< sub-pixel points of the edge that support the circle
  std::vector<EdgeSegment> segments;  ///< the Hough segments along the edge
};

/// Finds the edge of a drop, any arc of 10 degrees or more, and its circle (theory A13): percentile
/// stretch, Gaussian smoothing, Roberts edges, Hough segments, all edge pixels supporting them, RANSAC,
/// Pratt. The picture's halved copies are searched the same way, so that blurred and noisy edges are seen
/// too. Every circle is then tested along its whole arc (weigh_arc), which also gives the sub-pixel edge
/// points for the last fit (Levenberg-Marquardt with covariance; the sd allow for edges that wander off a
/// circle slowly). The place of the edge is the half level of a step and the middle of a line
/// (fit_edge_profile). Same picture, same result. Throws Error(Errc::input, options.name): picture too small,
/// not finite or uniform; no circle better supported than chance explains; a straight line; too short an arc;
/// a radius too unsure; an arc mostly without an edge.
DropEdge find_drop_edge(const GrayF& picture, const DropEdgeOptions& options = {});

}  // namespace faba
