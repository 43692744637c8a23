#pragma once
#include <string>
#include <vector>

#include "vision/ruler/mark_row.h"

namespace faba {

/// Parameters of find_ruler.
struct RulerOptions {
  int min_marks = 5;                    ///< minimum number of marks in a row
  double max_residual_fraction = 0.08;  ///< maximum residual as a fraction of the pitch
  std::string name = "ruler";           ///< place named in errors: the file name of the picture
};

/// A ruler in a picture: its finest row of marks. Lengths in px of the picture; pixel centres at integers, y
/// down.
struct Ruler {
  MarkRow row;
  double angle_deg =
      0;  ///< direction along the ruler, from the x axis of the picture towards its y axis, -90..90
  int image_width = 0, image_height = 0;
};

/// Measures the distance between neighbouring finest marks of a ruler or stage micrometer with sub-pixel
/// accuracy, at any angle, in a part of the picture, in uneven light, beside text and scale bars. Method:
/// find_periods, RowMeter::measure for each hint; among the rows, the finest one whose pitch divides that of
/// the best supported row (short and long marks have integer ratios). The distance is measured between equal
/// points of neighbouring marks, so the width of the marks has no influence. Deterministic. Throws
/// Error(Errc::input, options.name) when the picture is too small, not finite or uniform, has no periodic
/// structure, too few marks, or two scales with similar support whose pitches have no integer ratio.
Ruler find_ruler(const GrayF& picture, const RulerOptions& options = {});

}  // namespace faba
