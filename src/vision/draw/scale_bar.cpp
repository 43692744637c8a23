#include "vision/draw/scale_bar.h"

#include <fmt/format.h>

#include <cmath>

namespace faba {

ScaleBar scale_bar_for(int width_px, std::optional<double> um_per_px) {
  const double per_px = um_per_px.value_or(1), longest = 0.25 * width_px * per_px;
  double um = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double f : {5.0, 2.0})
    if (um * f <= longest) {
      um *= f;
      break;
    }
  if (!um_per_px) return {um, fmt::format("{:g} px", um)};
  return {um / per_px, um < 1000 ? fmt::format("{:g} um", um) : fmt::format("{:g} mm", um / 1000)};
}

}  // namespace faba
