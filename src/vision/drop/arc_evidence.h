#pragma once
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "vision/drop/arc_strip.h"
#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// What a picture says about one circle being an edge in it.
struct ArcEvidence {
  /// log10 of the number of circles that would fit a picture of independent noise as well, among all circles
  /// distinguishable in it (a-contrario test). Far below 0: an edge. Above 0: chance.
  double log10_false_alarms = 1e9;
  std::vector<Vec2> points;  ///< where the pieces of the supported run see the edge, sub-pixel, along the arc
  std::size_t visible = 0;   ///< pieces of the circle that lie in the picture
  double support = 0;        ///< pieces that agree with the circle / visible pieces, 0..1
  double piece_px = 0;       ///< length of one piece
  double length_px = 0;      ///< length of arc that agrees
  double tolerance_px = 0;   ///< distance from the circle within which a piece agrees with it
  double relief = 0;         ///< rms of the mean profile about its best straight line, grey of the picture
  std::vector<double> angles;  ///< directions (rad, from x to y) of the pieces that agree, several in each
};

/// Tests the circle without assuming how an edge looks. The visible arc is cut into pieces; each piece is
/// asked where along its radius the mean profile of all OTHER pieces fits best or, when that is not clear,
/// where its own grey changes (align_by_profile, align_by_change). At an edge, whatever its shape, contrast
/// and noise, the answers agree on zero; anywhere else they are spread evenly over the search range. The
/// count of pieces that agree, over the best contiguous run of the arc, is then a binomial variable, and what
/// was chosen among (circles, runs, tolerances) is paid for as in an a-contrario test.
ArcEvidence weigh_arc(const GrayF& picture, const Circle& circle, const ArcStripOptions& options = {});

}  // namespace faba
