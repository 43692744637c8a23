#pragma once
#include <cstdint>

#include "core/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// What turns light into grey values. Light is a share of white.
struct CameraSensor {
  double lamp = 1;        ///< factor on the light of the whole frame
  double shot = 0;        ///< variance of the noise per light, shares of white: 1 / full well
  double constant = 0;    ///< variance of the noise without light, shares of white squared
  bool absorbing = true;  ///< cells take light away, exp(-cells); else they add it, 1 + cells
  std::uint64_t seed = 1;
  std::uint32_t frame = 0;  ///< number of the frame: its noise is a function of seed, frame and pixel
};

/// Grey = round(white (light + sqrt(shot light + constant) z)), clipped to 0..white, with
/// light = lamp ground exp(-cells) or lamp ground (1 + cells) and z standard normal, from Philox in blocks of
/// 1024 pixels. White is the largest value of the type. `ground`, `cells` and `out` have one size. Same bits
/// for any number of threads and on every machine (theory G3).
void expose(const CameraSensor& sensor, const GrayF& ground, const GrayF& cells, Pool& pool, Gray8& out);
void expose(const CameraSensor& sensor, const GrayF& ground, const GrayF& cells, Pool& pool,
            Image<std::uint16_t>& out);  ///< The same in 16 bits.

}  // namespace faba
