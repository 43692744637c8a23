#pragma once
#include <optional>
#include <string>

namespace faba {

/// Scale bar: the largest of 1, 2 and 5 times a power of ten micrometres, or pixels without a scale, that
/// fits into a quarter of the picture width.
struct ScaleBar {
  double length_px = 0;
  std::string label;  ///< "200 um", "1 mm", "100 px"
};
ScaleBar scale_bar_for(int width_px, std::optional<double> um_per_px);

}  // namespace faba
