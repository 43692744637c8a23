#pragma once
#include <cmath>

#include "study/motion/signature.h"

namespace faba::test {

/// A pair of frames `k` of a video of 10 frames per second: the upper left quarter of the image moves by (u,
/// v), the rest does not move.
inline FlowPair moving_quarter(std::uint64_t k, double u, double v, int width = 32, int height = 20) {
  FlowPair p;
  p.frame = k;
  p.t0_s = 0.1 * double(k);
  p.t1_s = 0.1 * double(k + 1);
  p.flow = {GrayF(width, height), GrayF(width, height)};
  for (int r = 0; r < height / 2; ++r)
    for (int c = 0; c < width / 2; ++c) {
      p.flow.u.at(c, r) = float(u);
      p.flow.v.at(c, r) = float(v);
    }
  return p;
}

}  // namespace faba::test
