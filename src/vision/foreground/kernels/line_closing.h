#pragma once
#include <limits>

#include "core/threads/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// Morphological closings of a picture by a line segment in 24 directions: in each direction, the minimum
/// over all segments through the pixel of the maximum along the segment.
struct LineClosing {
  /// Minimum over all directions. A dark object shorter than the segment in every direction is filled to the
  /// level of its surroundings; a longer dark line, such as the edge of a drop, remains, up to its brightest
  /// pixel within the segment. Noise raises the result by about its standard deviation.
  GrayF least;
  GrayF largest;  ///< maximum over all directions: lines are filled as well
};

/// `length_px`: length of the segment, at least 3. `radius_px`: radius of the segments, which are bent to
/// either side, so that a circular line with this radius remains; by default they are straight. Bit-identical
/// on every machine, and for any number of threads.
LineClosing line_closing(const GrayF& picture, double length_px, Pool& pool,
                         double radius_px = std::numeric_limits<double>::infinity());

}  // namespace faba
