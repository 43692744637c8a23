#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// A piece of the arc along which a circle crosses a picture.
struct ArcPiece {
  double angle = 0, width = 0;  ///< rad: direction of its middle, from x to y, and angle between its ends
  std::vector<double> grey;     ///< across it, at radius - half, ..., radius + half px
  std::size_t stretch = 0;  ///< number of the unbroken part of the circle in the picture that it belongs to
  double shift = 0;  ///< where it sees the edge, px from the circle outward; set by the align functions
};

/// The visible arc of a circle, cut into pieces of equal length, in the order of their angles.
struct ArcStrip {
  std::vector<ArcPiece> pieces;
  bool closed = false;  ///< the whole circle is in the picture: the last piece touches the first
  int half = 0;         ///< pieces reach this far from the circle, px
  double piece_px = 0;  ///< length of a piece along the arc

  int reach() const { return half / 2; }  ///< shifts lie in -reach..reach
};

/// How a strip is cut. Lengths in px of the picture.
struct ArcStripOptions {
  int half_width = 24;   ///< profiles run from this far inside the circle to this far outside; even
  double border_px = 6;  ///< the arc nearer than this to the picture's border is left out
  double piece_px = 6;   ///< shortest piece
  int max_pieces = 128;  ///< longer pieces are used on longer arcs
};

/// Reads the strip: grey interpolated bilinearly every px along and across the arc, averaged over each piece
/// without the lowest and highest quarter. Positions outside the picture take the nearest border pixel. No
/// pieces when the circle does not cross the picture.
ArcStrip read_arc_strip(const GrayF& picture, const Circle& circle, const ArcStripOptions& options = {});

/// Sets every shift to where the mean profile of all OTHER pieces fits best in that piece: largest product of
/// the two (the mean without its straight line), relative to the unrest of the grey there. Knows no shape of
/// edge, and is blind to light that varies linearly. Sub-pixel.
void align_by_profile(ArcStrip& strip);

/// Sets every shift to where the grey of that piece changes from one mean and spread to another, by
/// likelihood: an edge with a coarse texture on one side has no common profile, but a beginning. To half a
/// pixel.
void align_by_change(ArcStrip& strip);

/// Mean grey across a circle in the directions given: element i belongs to radius + (i - half) px. The lowest
/// and the highest quarter at each radius do not count, so that cells and dust do not.
std::vector<double> mean_profile(const GrayF& picture, const Circle& circle, std::span<const double> angles,
                                 int half);

/// Takes mean and slope out of v, an odd number of values at least 3, so that its product with any straight
/// line is 0.
void remove_line(std::vector<double>& v);

}  // namespace faba
