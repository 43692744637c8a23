#include "vision/draw/scale_bar.h"

#include <fmt/format.h>

#include <cmath>

namespace faba {

ScaleBar scale_bar_for(int width_px, double um_per_px) {
  const double max_um = 0.25 * width_px * um_per_px;
  double um = std::pow(10.0, std::floor(std::log10(max_um)));
  for (const double f : {5.0, 2.0})
    if (um * f <= max_um) {
      um *= f;
      break;
    }
  return {um / um_per_px, um < 1000 ? fmt::format("{:g} um", um) : fmt::format("{:g} mm", um / 1000)};
}

}  // namespace faba
