#pragma once
#include <vector>

#include "core/vec.h"

#include "vision/cells/spot.h"
#include "vision/image/image.h"

/// The sub-pixel part of the detector; include detector.h instead.
namespace faba {

inline constexpr double kFwhmPerSd = 2.354820045;  ///< full width at half maximum of a Gaussian over its sd

/// Where a spot was seen to the pixel.
struct SpotSeed {
  int col = 0, row = 0;
  double snr = 0;
  double noise = 0;  ///< sd of the picture's noise there, grey
};

/// Centre, mass and shape of each seed's spot in a picture of differences (spots positive) by moments under a
/// Gaussian window of `sd_px`, the offset of the surroundings and the light of the other spots taken off. A
/// spot whose window runs away from its seed by more than 1.5 sd, or has no positive mass, is left out.
std::vector<Spot> fit_spots(const GrayF& difference, const std::vector<SpotSeed>& seeds, double sd_px);

}  // namespace faba
