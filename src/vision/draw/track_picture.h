#pragma once
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// Path of a track, or its last part, for drawing. Picture px, y down.
struct TrackLine {
  std::uint64_t number = 0;  ///< selects the colour
  std::vector<Vec2> path;    ///< in temporal order
  bool seen = true;  ///< whether the last position belongs to the current frame; it is then drawn with a ring
};

/// A grey frame (contrast range `black` to `white`) with track paths: thin lines in one of six colours of the
/// Okabe-Ito palette and, with `rings`, a ring of radius `ring_px` around the last position of each track
/// that is visible in the current frame. Same size as the frame.
RgbImage draw_tracks(const GrayF& frame, float black, float white, const std::vector<TrackLine>& tracks,
                     bool rings, double ring_px);

}  // namespace faba
