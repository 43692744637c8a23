#pragma once
#include "vision/image/image.h"

namespace faba {

/// A picture without its small dark things: in each of 24 directions the closing by a straight piece (the
/// least that a piece through the pixel has as its largest value).
struct LineClosing {
  /// Of all directions the least. A dark thing shorter than the piece in every direction is filled up to what
  /// is around it; a dark line that is longer, as the edge of a drop, stays, up to its own brightest place
  /// within the piece. Noise lifts it by about its standard deviation.
  GrayF least;
  GrayF largest;  ///< of all directions the largest: lines are filled, too
};

/// `length_px` of the piece, 3 or more. Same bits on every machine.
LineClosing line_closing(const GrayF& picture, double length_px);

}  // namespace faba
