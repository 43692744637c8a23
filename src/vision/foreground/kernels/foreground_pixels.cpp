#include "vision/foreground/kernels/foreground_pixels.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/portable_math.h"
#include "core/vectorised.h"

namespace faba {
namespace {

inline float larger(float a, float b) { return a > b ? a : b; }

}  // namespace

FABA_VECTORISED void to_float(const std::uint8_t* picture, float* out, int n) {
  for (int i = 0; i < n; ++i) out[i] = float(picture[i]);
}

void dilate(std::vector<std::uint8_t>& m, std::vector<std::uint8_t>& work, int w, int h, int reach) {
  work.assign(m.size(), 0);
  for (int row = 0; row < h; ++row) {
    const std::uint8_t* in = &m[std::size_t(row) * std::size_t(w)];
    std::uint8_t* out = &work[std::size_t(row) * std::size_t(w)];
    for (int k = -reach; k <= reach; ++k) {
      const int first = std::max(0, -k), end = std::min(w, w - k);
      for (int i = first; i < end; ++i) out[i] |= in[i + k];
    }
  }
  m.assign(m.size(), 0);
  for (int row = 0; row < h; ++row) {
    std::uint8_t* out = &m[std::size_t(row) * std::size_t(w)];
    for (int r = std::max(0, row - reach); r <= std::min(h - 1, row + reach); ++r) {
      const std::uint8_t* in = &work[std::size_t(r) * std::size_t(w)];
      for (int i = 0; i < w; ++i) out[i] |= in[i];
    }
  }
}

FABA_VECTORISED void difference(const float* picture, const float* background, float gain, float sign,
                                float* out, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] = sign * (picture[i] - gain * background[i]);
}

FABA_VECTORISED void above(const float* v, float threshold, std::uint8_t* mask, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) mask[i] = v[i] > threshold ? 1 : 0;
}

FABA_VECTORISED void lost_light(const float* picture, const float* background, const std::uint8_t* covered,
                                const LightLoss& p, float* weights, int n) {
  const LightLoss q = p;
  const auto one = [q](float grey, float ground) {
    const float light = ground * q.gain > 1.0F ? ground * q.gain : 1.0F;
    const float least = 0.02F * light > 1.0F ? 0.02F * light : 1.0F;
    const float left = (grey > least ? grey : least) / light;
    const float relative = q.noise / light;
    return q.level * (-portable::log(left) - 0.5F * relative * relative);
  };
  constexpr int kBlock = 16;
  int i = 0;
  for (; i + kBlock <= n; i += kBlock) {
    std::uint64_t some[2];
    std::memcpy(some, covered + i, kBlock);
    if ((some[0] | some[1]) == 0) continue;
    FABA_ELEMENTWISE
    for (int k = i; k < i + kBlock; ++k) {
      const float v = one(picture[k], background[k]);
      weights[k] = covered[k] ? v : weights[k];
    }
  }
  for (; i < n; ++i)
    if (covered[i]) weights[i] = one(picture[i], background[i]);
}

FABA_VECTORISED void mark_peaks(const float* v, int width, const std::uint8_t* covered, std::uint8_t* peak,
                                int n) {
  const float *up = v - width, *down = v + width;
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) {
    const float before = larger(larger(v[i - 1], up[i]), larger(up[i - 1], up[i + 1]));
    const float after = larger(larger(v[i + 1], down[i]), larger(down[i - 1], down[i + 1]));
    peak[i] = std::uint8_t(covered[i] & std::uint8_t(v[i] >= before) & std::uint8_t(v[i] > after));
  }
}

FABA_VECTORISED void clear_uncovered(const std::uint8_t* covered, float* v, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) v[i] = covered[i] ? v[i] : 0.0F;
}

FABA_VECTORISED void follow_picture(const float* picture, const float* weights, const float* smooth,
                                    const std::uint8_t* covered, const Following& p, std::uint8_t* guess,
                                    float* background, int n) {
  const Following q = p;
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) {
    const bool lighter = (weights[i] < q.least_weight) | (smooth[i] < q.least_smooth);
    const bool wrong = (guess[i] & kDisproved) != 0;
    const float normal_rate = covered[i] ? q.absorb : q.follow;
    const float rate = (lighter | wrong) ? q.at_once : normal_rate;
    background[i] = q.next * (background[i] + rate * (q.back * picture[i] - background[i]));
    guess[i] = lighter ? std::uint8_t(0) : std::uint8_t(guess[i] & std::uint8_t(~kDisproved));
  }
}

}  // namespace faba
