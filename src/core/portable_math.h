#pragma once
#include <cmath>
#include <cstdint>

#include "core/portable.h"

/// Elementary functions that give the same bits on x86-64 and arm64 and in WebAssembly, at every optimisation
/// level: only IEEE additions, multiplications, divisions and square roots, no fused multiply-add (the build
/// sets -ffp-contract=off), no libm, whose variants for different processors differ in the last bit.
/// Branch-free, so that loops vectorise.
namespace faba::portable {

inline constexpr float kPiF = 3.14159265358979f;
inline constexpr double kPi = 3.14159265358979323846;

/// Nearest integer, ties to even, for |x| < 2^22. Adding and subtracting 1.5 * 2^23 needs SSE2 only.
[[gnu::always_inline]] inline float nearest(float x) { return (x + 12582912.0f) - 12582912.0f; }

struct SinCos {
  float sin, cos;
};

/// Sine and cosine of an angle in rad, |a| <= 1e4; absolute error below 1.5e-7.
[[gnu::always_inline]] inline SinCos sincos(float a) {
  const float q = nearest(a * 0.636619772f);
  const auto quadrant = std::int32_t(q);
  // pi/2 in three parts, the first two exact in products with q < 2^13
  const float r = ((a - q * 1.5703125f) - q * 4.837512969970703e-4f) - q * 7.549789948768648e-8f;
  const float z = r * r;
  const float s = r + r * z * (-1.6666654611e-1f + z * (8.3321608736e-3f - 1.9515295891e-4f * z));
  const float c = 1.0f - 0.5f * z +
                  z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + 2.443315711809948e-5f * z));
  const bool swap = (quadrant & 1) != 0;
  const float sn = swap ? c : s, cs = swap ? s : c;
  return {(quadrant & 2) != 0 ? -sn : sn, ((quadrant + 1) & 2) != 0 ? -cs : cs};
}

/// Natural logarithm of a normal positive float; relative error below 1e-7 (absolute near 1).
[[gnu::always_inline]] inline float log(float v) {
  const auto bits = bit_cast<std::int32_t>(v);
  const std::int32_t e = (bits - 0x3f3504f3) >> 23;  // v = m 2^e, m in [sqrt(1/2), sqrt(2))
  const float m = bit_cast<float>(bits - e * (1 << 23)) - 1.0f;
  const float z = m * m;
  const float p =
      ((((((((7.0376836292e-2f * m - 1.1514610310e-1f) * m + 1.1676998740e-1f) * m - 1.2420140846e-1f) * m +
           1.4249322787e-1f) *
              m -
          1.6668057665e-1f) *
             m +
         2.0000714765e-1f) *
            m -
        2.4999993993e-1f) *
           m +
       3.3333331174e-1f) *
      m * z;
  const auto fe = float(e);
  return m + ((p - 2.12194440e-4f * fe) - 0.5f * z) + 0.693359375f * fe;
}

/// e^x, x clamped to [-87, 88]; relative error below 2e-7.
[[gnu::always_inline]] inline float exp(float x) {
  x = x < -87.0f ? -87.0f : x > 88.0f ? 88.0f : x;
  const float n = nearest(x * 1.44269504f);
  const float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
  const float p =
      ((((1.9875691500e-4f * r + 1.3981999507e-3f) * r + 8.3334519073e-3f) * r + 4.1665795894e-2f) * r +
       1.6666665459e-1f) *
          r +
      5.0000001201e-1f;
  const float y = 1.0f + (r + p * r * r);
  return y * bit_cast<float>((std::int32_t(n) + 127) * (1 << 23));
}

/// Double versions for set-up and the once-per-step scalars; about 1 ulp.
double exp(double x);
double log(double x);
struct SinCosD {
  double sin, cos;
};
SinCosD sincos(double a);  ///< |a| <= 1e8
double atan2(double y, double x);
/// Cumulative distribution function of the standard normal distribution; absolute error below 1e-7
/// (Abramowitz & Stegun 26.2.17).
double normal_cdf(double x);

}  // namespace faba::portable
