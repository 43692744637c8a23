#pragma once
#include <string>
#include <vector>

#include "vision/ruler/mark_row.h"

namespace faba {

/// Parameters of find_ruler.
struct RulerOptions {
  int min_marks = 5;                 ///< fewer marks in a row are refused
  double max_residual_share = 0.08;  ///< marks scattering by more than this share of the pitch are no ruler
  std::string name = "ruler";        ///< `where` of errors: give the picture's file name
};

/// A ruler in a picture: its finest row of marks. Lengths in px of the picture; pixel centres at integers, y
/// down.
struct Ruler {
  MarkRow row;
  double angle_deg = 0;  ///< direction along the ruler, from the picture's x axis towards its y axis, -90..90
  int image_width = 0, image_height = 0;
};

/// Finds the finest marks of a ruler or stage micrometer and the distance between neighbouring ones, to a
/// small part of a pixel, in a ruler turned by any angle, in part of the picture, in uneven light, beside
/// text and scale bars: find_periods, measure_marks for what it hints at, and of the rows measured the finest
/// that fits in with the one best supported: their pitches must be in a whole ratio, as those of short and
/// long marks are. What counts is the distance between marks, from the same point of one to that of the next:
/// how wide the marks look plays no part. Same picture, same result. Throws Error(Errc::input, options.name):
/// picture too small, not finite or uniform; nothing that repeats; too few marks; two scales of like support
/// whose pitches do not go with each other.
Ruler find_ruler(const GrayF& picture, const RulerOptions& options = {});

}  // namespace faba
