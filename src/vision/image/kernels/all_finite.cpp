#include "vision/image/kernels/all_finite.h"

#include <cstdint>

#include "core/portable.h"
#include "core/vectorised.h"

namespace faba {
namespace {

// The exponents of values that are not finite have all bits set. Unlike the sum of 0 times the values, the
// largest of integers may be computed in any order.
FABA_VECTORISED std::uint32_t largest_exponent(const float* px, int n) {
  std::uint32_t largest = 0;
  for (int i = 0; i < n; ++i) {
    const std::uint32_t exponent = portable::bit_cast<std::uint32_t>(px[i]) & 0x7f800000U;
    largest = exponent > largest ? exponent : largest;
  }
  return largest;
}

}  // namespace

bool all_finite(const GrayF& frame) {
  return largest_exponent(frame.px.data(), int(frame.px.size())) < 0x7f800000U;
}

}  // namespace faba
