#include "vision/files/kernels/luma.h"

#include "core/vectorised.h"

namespace faba {
namespace {

FABA_VECTORISED void apply(const std::uint8_t* luma, float black, float gain, float white, float* out,
                           int n) {
  const GreyMap map{black, gain, white};
  for (int i = 0; i < n; ++i) out[i] = map(float(luma[i]));
}

}  // namespace

void grey_of_luma(const std::uint8_t* luma, const GreyMap& map, float* out, int n) {
  apply(luma, map.black, map.gain, map.white, out, n);
}

}  // namespace faba
