#pragma once
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// The path of one track, or its last part, for drawing. Picture px, y down.
struct TrackLine {
  std::uint64_t number = 0;  ///< gives the colour
  std::vector<Vec2> path;    ///< in the order of time
  bool seen = true;          ///< the last place is one of now: it gets a ring
};

/// A frame in grey (between the grey values `black` and `white`) with paths drawn on it: thin lines in one of
/// six colours of the Okabe-Ito palette by number, and, when `rings` is set, a ring of `ring_px` around the
/// last place of each track that is seen. Same size as the frame.
RgbImage draw_tracks(const GrayF& frame, float black, float white, const std::vector<TrackLine>& tracks,
                     bool rings, double ring_px);

}  // namespace faba
