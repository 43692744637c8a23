#pragma once
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/drop/drop_edge_options.h"
#include "vision/image/circle.h"
#include "vision/image/image.h"

namespace faba {

/// The edge of a drop: a circle with uncertainty. Image frame: x right, y down, px, pixel centres at
/// integers.
struct DropEdge {
  Vec2 centre_image;  ///< may lie far outside the picture
  double radius_px = 0;
  Vec2 sd_centre_px;        ///< standard deviations, from the residuals of the edge points
  double sd_radius_px = 0;  ///< includes the deviation of an elliptical edge from the circle
  /// Half the difference of the axes of an ellipse along the edge; 0: not significant, or less than half a
  /// circle.
  double out_of_round_px = 0;
  std::optional<Circle> other;  ///< another circular edge in the picture, as significant as an edge must be
  double arc_deg = 0;           ///< angle of the supporting arc seen from the centre, 0..360
  Vec2 inside_image;            ///< a point of the picture that is inside the drop
  bool centre_side_inside = true;  ///< whether the drop is on the side of the centre
  int image_width = 0, image_height = 0;
  double contrast = 0;       ///< step: grey inside minus outside; line: grey at the centre minus beside it
  double edge_width_px = 0;  ///< Gaussian sd of the blurred step or line
  double support = 0;        ///< fraction of the visible arc along which the edge was detected, 0..1
  double log10_false_alarms = 0;      ///< expected number of such circles in noise; see ArcEvidence
  std::vector<Vec2> edge_points;      ///< sub-pixel points of the edge that support the circle
  std::vector<EdgeSegment> segments;  ///< Hough segments along the edge
};

/// Detects the edge of a drop (any arc of 10 degrees or more) and its circle (theory A13): percentile
/// stretch, Gaussian smoothing, Roberts edges, Hough segments, supporting edge pixels, RANSAC, Pratt. Coarser
/// pyramid levels are searched in the same way, for blurred and noisy edges. Every circle is then tested
/// along its visible arc (evaluate_arc), which also gives the sub-pixel edge points of the last fit
/// (Levenberg-Marquardt with covariance; the sd include correlated deviations of the edge from a circle). The
/// edge position is the half level of a step or the centre of a line (fit_edge_profile). Deterministic.
/// Throws Error(Errc::input, options.name) when the picture is too small, not finite or uniform, when no
/// circle is significant against noise, when the edge is a straight line, the arc too short or the radius too
/// uncertain, or when most of the arc has no edge.
DropEdge find_drop_edge(const GrayF& picture, const DropEdgeOptions& options = {});

}  // namespace faba
