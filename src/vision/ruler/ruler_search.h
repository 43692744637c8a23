#pragma once
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// A strip of a picture in which something repeats, as the marks of a ruler do. A guess to be measured.
struct PeriodHint {
  double angle = 0;      ///< rad, across the marks, from the picture's x axis towards its y axis
  double pitch_px = 0;   ///< smallest distance at which the strip repeats, to some 2 %
  double across_px = 0;  ///< the strip's middle: t of TurnedPicture(picture, angle)
  int height_px = 0;     ///< of the strip
  double evidence = 0;   ///< periodicity times the root of the strip's length; noise stays below about 5
};

/// Directions that edges in the picture lie across, strongest first, rad in [-pi/2, pi/2): peaks of the
/// histogram of the grey gradient's direction, over two smoothings, each with the direction at right angles.
/// At most `most`.
std::vector<double> edge_directions(const GrayF& picture, int most);

/// Looks for repeating marks of any direction and of a pitch from 3 px to a quarter of the picture: along
/// each of the strongest edge directions the picture, and copies of it halved again and again, are cut into
/// strips of three heights; each strip's grey profile is flattened and its autocorrelation searched. The
/// fundamental is the smallest distance that repeats about as well as the best one does, where a distance
/// counts that repeats at its multiples and not half-way between: so neither the two edges of a mark nor
/// every fifth or tenth mark being longer is taken for the pitch. Strips that repeat, best first.
std::vector<PeriodHint> find_periods(const GrayF& picture);

}  // namespace faba
