#pragma once
#include <cstdint>
#include <vector>

namespace faba {

/// Numbers the connected patches of a mask, neighbours across corners included: `labels` is 0 where the mask
/// is 0, else the number of the patch, from 1. Returns the number of patches. `mask` holds width * height
/// pixels.
int label_patches(const std::vector<std::uint8_t>& mask, int width, int height, std::vector<int>& labels);

}  // namespace faba
