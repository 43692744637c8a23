#include "study/tracks/cell_view.h"

#include <cmath>
#include <numbers>

namespace faba {

Detector CellView::detector() const {
  DetectorOptions o;
  o.size_px = cells.cell_px;
  o.polarity = cells.polarity;
  o.threshold_sd = threshold_sd;
  return {*background, o};
}

Foreground CellView::foreground_in(const GrayF& frame) const {
  Foreground foreground(cells);
  foreground.set_background(*background);
  foreground.take(frame, noise(), frame_s);
  return foreground;
}

Vec2 unit_vector(double deg) {
  const double a = deg * std::numbers::pi / 180;
  return {std::cos(a), std::sin(a)};
}

}  // namespace faba
