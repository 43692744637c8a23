#pragma once
#include <vector>

#include "core/vec.h"

#include "vision/cells/spot.h"
#include "vision/image/image.h"

/// Sub-pixel fit of the detector (internal; include detector.h instead).
namespace faba {

inline constexpr double kFwhmPerSd = 2.354820045;  ///< full width at half maximum of a Gaussian over its sd

/// Position of a spot to the pixel.
struct SpotSeed {
  int col = 0, row = 0;
  double snr = 0;
  double noise = 0;  ///< sd of the noise at this position, grey
};

/// Centre, mass and shape of the spot at each seed in a difference picture (spots positive), from moments
/// under a Gaussian window of `sd_px`; the local offset and the light of other spots are subtracted. A spot
/// whose window moves away from its seed by more than 1.5 sd, or which has no positive mass, is discarded.
std::vector<Spot> fit_spots(const GrayF& difference, const std::vector<SpotSeed>& seeds, double sd_px);

}  // namespace faba
