#pragma once
#include <memory>

#include "core/vec.h"
#include "vision/cells/detector.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// Appearance of the cells in the frames of an experiment: grey levels 0 to 255.
struct CellView {
  int width = 0, height = 0;                     ///< px
  double frame_s = 0;                            ///< frame period
  ForegroundOptions cells;                       ///< appearance of a cell
  std::shared_ptr<const Background> background;  ///< empty background, with uniform noise
  double threshold_sd = 0;                       ///< smallest signal-to-noise ratio of a tracked cell
  double search_radius_px = 0;                   ///< largest displacement between frames

  double noise() const { return double(background->noise_sd.px.front()); }  ///< sd of a pixel, grey
  /// Detects single cells.
  Detector detector() const;
  /// Foreground of a frame, without detection of single cells.
  Foreground foreground_in(const GrayF& frame) const;
};

/// Unit vector at an angle: (cos, sin).
Vec2 unit_vector(double deg);

}  // namespace faba
