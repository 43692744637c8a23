#include "study/plot/plot_map.h"

#include <algorithm>

namespace faba::drawing {
namespace {

double coordinate(double fraction, bool flip, double size) {
  return std::clamp((flip ? 1 - fraction : fraction) * size, -kMaxCoordinate, kMaxCoordinate);
}

}  // namespace

double Map::to_x(double v) const { return coordinate((v - x.lo) / x.length(), flip_x, w); }
double Map::to_y(double v) const { return coordinate((v - y.lo) / y.length(), !flip_y, h); }

}  // namespace faba::drawing
