#pragma once
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// A strip of a picture with a periodic structure such as the marks of a ruler; a candidate for measurement.
struct PeriodHint {
  double angle = 0;  ///< rad, direction across the marks, from the x axis of the picture towards its y axis
  double pitch_px = 0;   ///< fundamental period of the strip, to about 2 %
  double across_px = 0;  ///< centre of the strip: t of RotatedPicture(picture, angle)
  int height_px = 0;     ///< height of the strip
  double evidence = 0;   ///< periodicity times the square root of the strip length; below about 5 for noise
};

/// Gradient directions of the edges in the picture, strongest first, rad in [-pi/2, pi/2): peaks of the
/// histogram of the gradient direction for two smoothing widths, each also with the perpendicular direction.
/// At most `most` directions.
std::vector<double> edge_directions(const GrayF& picture, int most);

/// Detects periodic marks of any direction with a pitch from 3 px to a quarter of the picture. For each of
/// the strongest edge directions, all pyramid levels are divided into strips of three heights, and the
/// autocorrelation of the flattened grey profile of each strip is searched. The fundamental is the smallest
/// lag with a score close to the best one, where the score compares the autocorrelation at multiples of the
/// lag with that half-way between; so neither the two edges of a mark nor longer marks (every fifth or tenth)
/// are taken for the pitch. Returns periodic strips, best first.
std::vector<PeriodHint> find_periods(const GrayF& picture);

}  // namespace faba
