#pragma once
#include <cstdint>

namespace faba {

/// Linear map from a stored value to grey, clipped to the scale.
struct GreyMap {
  float black = 0, gain = 1, white = 255;
  float operator()(float stored) const {
    const float grey = (stored - black) * gain;
    const float least = grey < 0.0F ? 0.0F : grey;
    return least > white ? white : least;
  }
};

/// out[i] = map(luma[i]).
void grey_of_luma(const std::uint8_t* luma, const GreyMap& map, float* out, int n);

}  // namespace faba
