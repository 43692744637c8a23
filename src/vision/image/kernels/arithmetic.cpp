#include "vision/image/kernels/arithmetic.h"

#include <cstddef>

#include "core/vectorised.h"

namespace faba {
namespace {

FABA_VECTORISED void subtract_px(const float* a, const float* b, float* out, std::size_t n) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] - b[i];
}

FABA_VECTORISED void multiply_px(float* a, float by, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) a[i] *= by;
}

FABA_VECTORISED void multiply_px_by_px(float* a, const float* by, std::size_t n) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) a[i] *= by[i];
}

}  // namespace

GrayF difference(const GrayF& a, const GrayF& b) {
  GrayF out(a.width, a.height);
  subtract_px(a.px.data(), b.px.data(), out.px.data(), out.px.size());
  return out;
}

void subtract(GrayF& a, const GrayF& b) { subtract_px(a.px.data(), b.px.data(), a.px.data(), a.px.size()); }

void multiply(GrayF& a, float by) { multiply_px(a.px.data(), by, a.px.size()); }

void multiply(GrayF& a, const GrayF& by) { multiply_px_by_px(a.px.data(), by.px.data(), a.px.size()); }

}  // namespace faba
