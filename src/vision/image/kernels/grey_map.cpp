#include "vision/image/kernels/grey_map.h"

#include <limits>

#include "core/portable.h"
#include "core/vectorised.h"

namespace faba {
namespace {

template <class T>
[[gnu::always_inline]] inline void apply(const T* stored, int n, const GreyMap& by, float* grey) {
  const GreyMap map = by;  // no alias of `grey`
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) grey[i] = map(float(stored[i]));
}

// NaN is taken for 0, and then differs.
template <class T>
[[gnu::always_inline]] inline bool invert(const float* grey, int n, const GreyMap& by, T* stored) {
  constexpr auto kMost = float(std::numeric_limits<T>::max());
  const GreyMap map = by;
  const float per_grey = 1 / map.gain;
  std::uint32_t differ = 0;
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) {
    const float up = grey[i] * per_grey + map.black + 0.5F, least = up > 0.0F ? up : 0.0F;
    const int nearest = int(least < kMost ? least : kMost);
    stored[i] = T(nearest);
    differ |=
        portable::bit_cast<std::uint32_t>(map(float(nearest))) ^ portable::bit_cast<std::uint32_t>(grey[i]);
  }
  return differ == 0;
}

FABA_VECTORISED void apply_bytes(const std::uint8_t* stored, int n, const GreyMap& map, float* grey) {
  apply(stored, n, map, grey);
}
FABA_VECTORISED void apply_words(const std::uint16_t* stored, int n, const GreyMap& map, float* grey) {
  apply(stored, n, map, grey);
}
FABA_VECTORISED bool invert_bytes(const float* grey, int n, const GreyMap& map, std::uint8_t* stored) {
  return invert(grey, n, map, stored);
}
FABA_VECTORISED bool invert_words(const float* grey, int n, const GreyMap& map, std::uint16_t* stored) {
  return invert(grey, n, map, stored);
}

}  // namespace

void map_greys(const std::uint8_t* stored, std::size_t n, const GreyMap& map, float* grey) {
  apply_bytes(stored, int(n), map, grey);
}
void map_greys(const std::uint16_t* stored, std::size_t n, const GreyMap& map, float* grey) {
  apply_words(stored, int(n), map, grey);
}
bool unmap_greys(const float* grey, std::size_t n, const GreyMap& map, std::uint8_t* stored) {
  return invert_bytes(grey, int(n), map, stored);
}
bool unmap_greys(const float* grey, std::size_t n, const GreyMap& map, std::uint16_t* stored) {
  return invert_words(grey, int(n), map, stored);
}

}  // namespace faba
