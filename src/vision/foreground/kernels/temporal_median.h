#pragma once
#include <cstddef>
#include <span>

#include "vision/image/compact_image.h"
#include "vision/image/image.h"

namespace faba {

/// Of the pixels [begin, end) of frames of the same size, over all frames: the lower median, and the lower
/// median of the absolute deviations from it. Values are finite. The results are those of
/// robust_spread_low(), whose standard deviation is a multiple of the second one.
void temporal_medians(std::span<const CompactImage> frames, std::size_t begin, std::size_t end, GrayF& median,
                      GrayF& deviation);

}  // namespace faba
