#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/vec.h"
#include "vision/circle_fit.h"
#include "vision/image.h"

namespace faba {

/// Parameters of weigh_arc. Lengths in px of the picture given.
struct ArcEvidenceOptions {
  double half_width = 24;  ///< grey profiles run from this far inside the circle to this far outside
  double margin = 3;
  double piece_px = 6;     ///< the arc is cut into pieces at least this long, each judged by itself
  int max_pieces = 128;     ///< longer pieces are used on longer arcs
};

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
/// asked where the mean profile of all OTHER pieces fits best along its radius. At an edge, whatever its
/// shape, contrast and noise, they agree on zero; anywhere else the answers are spread evenly over the search
/// range. The count of pieces that agree, over the best contiguous run of the arc, is a binomial variable
/// under chance. A linear trend of grey along the radius (uneven light) has no say.
ArcEvidence weigh_arc(const GrayF& picture, const Circle& circle, const ArcEvidenceOptions& options = {});

/// Mean grey across a circle in the directions given: element i belongs to radius + (i - half) px. The lowest
/// and the highest quarter at each radius do not count, so that cells and dust do not.
std::vector<double> mean_profile(const GrayF& picture, const Circle& circle, std::span<const double> angles,
                                 int half);

}  // namespace faba
