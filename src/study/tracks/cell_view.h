#pragma once
#include <memory>

#include "core/vec.h"
#include "vision/cells/detector.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// What frames of an experiment look like, for whoever measures them: greys of 0 to 255.
struct CellView {
  int width = 0, height = 0;                     ///< px
  double frame_s = 0;                            ///< between frames
  ForegroundOptions cells;                       ///< how they look
  std::shared_ptr<const Background> background;  ///< where nothing is; the same noise everywhere
  double threshold_sd = 0;                       ///< least signal-to-noise of a cell that is followed
  double reach_px = 0;                           ///< farthest displacement of one from frame to frame

  double noise() const { return double(background->noise_sd.px.front()); }  ///< sd of a pixel, grey
  /// Finds cells one by one.
  Detector detector() const;
  /// What a frame shows of the swarm as a whole.
  Foreground seen_in(const GrayF& frame) const;
};

/// The direction at an angle: (cos, sin).
Vec2 unit_vector(double deg);

}  // namespace faba
