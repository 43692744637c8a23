#pragma once
#include <string>

namespace faba {

/// Scale bar: the largest of 1, 2 and 5 times a power of ten micrometres that fits into a quarter of the
/// picture width.
struct ScaleBar {
  double length_px = 0;
  std::string label;  ///< "200 um", "1 mm"
};
ScaleBar scale_bar_for(int width_px, double um_per_px);

}  // namespace faba
