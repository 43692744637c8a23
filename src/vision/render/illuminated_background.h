#pragma once
#include <cstdint>

#include "core/frame.h"
#include "vision/image/circle.h"
#include "vision/image/image.h"
#include "vision/render/microscope_params.h"

namespace faba {

/// Illumination of the empty picture as a fraction of white, without noise (theory G1):
///   level (1 - vignetting (r / r_corner)^2) (1 + unevenness waves)
///   (1 + (outside_level - 1) Phi(t)) (1 + edge_contrast exp(-t^2/2)),  t = (distance from centre - radius) /
///   w,
/// r is the distance from the picture centre. The waves have mean square 1, wavelengths between one and two
/// times the longer side of the picture, and directions and phases drawn from `seed`. w^2 = edge_width^2 +
/// psf_sd^2. `edge`: the drop, image frame, px; radius 0: no drop.
GrayF illuminated_background(const MicroscopeParams& p, const Frame& frame, const Circle& edge,
                             std::uint64_t seed);

}  // namespace faba
