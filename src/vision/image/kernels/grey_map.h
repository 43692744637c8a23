#pragma once
#include <cstddef>
#include <cstdint>

namespace faba {

/// Linear map from a stored integer to a grey level, clipped to [0, white]. Luma of 8 bits and limited range
/// is black at 16 and white at 235 (ITU-R BT.601).
struct GreyMap {
  float black = 0, gain = 1, white = 255;
  float operator()(float stored) const {
    const float grey = (stored - black) * gain;
    const float least = grey < 0.0F ? 0.0F : grey;
    return least > white ? white : least;
  }
};

/// grey[i] = map(stored[i]), for n values.
void map_greys(const std::uint8_t* stored, std::size_t n, const GreyMap& map, float* grey);
void map_greys(const std::uint16_t* stored, std::size_t n, const GreyMap& map, float* grey);

/// The inverse. Returns whether map_greys() gives each of the n grey values to the bit; otherwise `stored` is
/// undefined.
bool unmap_greys(const float* grey, std::size_t n, const GreyMap& map, std::uint8_t* stored);
bool unmap_greys(const float* grey, std::size_t n, const GreyMap& map, std::uint16_t* stored);

}  // namespace faba
