#pragma once
#include <cstdint>

#include "core/threads/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// Conversion of light to grey values. Light is a fraction of white.
struct CameraSensor {
  double lamp = 1;        ///< factor on the light of the frame
  double shot = 0;        ///< noise variance per light, fraction of white: 1 / full well
  double constant = 0;    ///< noise variance without light, fraction of white squared
  bool absorbing = true;  ///< true: cells absorb, exp(-cells); false: cells add light, 1 + emission cells
  double emission = 1;    ///< factor on added light, of bleaching
  std::uint64_t seed = 1;
  std::uint32_t frame = 0;  ///< frame number; the noise is a function of seed, frame and pixel
};

/// Grey = round(white (light + sqrt(shot light + constant) z)), clipped to 0..white, with light = lamp ground
/// exp(-cells) or lamp ground (1 + emission cells) and z standard normal, from Philox in blocks of 1024
/// pixels. White is the maximum of the pixel type. `ground`, `cells` and `out` have the same size.
/// Bit-identical for any number of threads and on every machine (theory G3).
void expose(const CameraSensor& sensor, const GrayF& ground, const GrayF& cells, Pool& pool, Gray8& out);
void expose(const CameraSensor& sensor, const GrayF& ground, const GrayF& cells, Pool& pool,
            Image<std::uint16_t>& out);  ///< As above, 16 bits.

}  // namespace faba
