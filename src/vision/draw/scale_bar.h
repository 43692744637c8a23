#pragma once
#include <string>

namespace faba {

/// A scale bar for a picture: the longest of 1, 2 and 5 times a power of ten micrometres that fits into a
/// quarter of its width.
struct ScaleBar {
  double length_px = 0;
  std::string words;  ///< "200 um", "1 mm"
};
ScaleBar scale_bar_for(int width_px, double um_per_px);

}  // namespace faba
