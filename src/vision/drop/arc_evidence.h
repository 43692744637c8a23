#pragma once
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "vision/drop/arc_strip.h"
#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// Evidence for one circle being an edge in a picture.
struct ArcEvidence {
  /// log10 of the expected number of false alarms: circles with equal support in a picture of independent
  /// noise, among all distinguishable circles (a-contrario test). Far below 0: an edge. Above 0: explained by
  /// noise.
  double log10_false_alarms = 1e9;
  std::vector<Vec2> points;    ///< sub-pixel edge positions of the supported run, along the arc
  std::size_t visible = 0;     ///< number of pieces of the circle inside the picture
  double support = 0;          ///< pieces that agree with the circle / visible pieces, 0..1
  double piece_px = 0;         ///< length of one piece
  double length_px = 0;        ///< arc length that agrees
  double tolerance_px = 0;     ///< maximum distance of an agreeing piece from the circle
  double relief = 0;           ///< rms of the mean profile about its linear fit, grey of the picture
  std::vector<double> angles;  ///< directions (rad, from x to y) of the pieces that agree, several in each
};

/// Tests a circle without a model of the edge. The visible arc is divided into pieces. For each piece the
/// radial shift is measured at which the mean profile of all OTHER pieces fits best or, if that is not
/// conclusive, at which its grey changes (align_by_profile, align_by_change). At an edge of any shape,
/// contrast and noise the shifts agree on zero; elsewhere they are uniform over the search range. The number
/// of agreeing pieces in the best contiguous run is then a binomial variable; the number of tests (circles,
/// runs, tolerances) is accounted for as in an a-contrario test.
ArcEvidence evaluate_arc(const GrayF& picture, const Circle& circle, const ArcStripOptions& options = {});

}  // namespace faba
