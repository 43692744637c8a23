#pragma once
#include "vision/cells/spot.h"

/// A spot at a place, px, with a signal-to-noise ratio of 10 and a localisation error of 0.1 px.
inline faba::Spot spot_at(double x, double y) {
  faba::Spot s;
  s.x_px = x;
  s.y_px = y;
  s.snr = 10;
  s.sd_px = 0.1;
  return s;
}
