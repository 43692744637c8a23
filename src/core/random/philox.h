#pragma once
#include <array>
#include <cstdint>

#include "core/portable_math.h"

namespace faba {

/// Independent physical processes use separate random streams. Append only; never renumber.
enum class Stream : std::uint32_t {
  start = 0,        ///< initial positions and properties of cells
  motion = 1,       ///< rotational and translational noise of one step
  translation = 2,  ///< reserved
  motility = 3,     ///< reversals, tumbles, tolerance to oxygen
  camera = 4,
  controller = 5,
  exclusion = 6,  ///< which cell wins a contested grid site
  study = 7       ///< designs and draws of studies; not used in a run
};

inline constexpr std::uint32_t kPhiloxM0 = 0xD2511F53u, kPhiloxM1 = 0xCD9E8D57u;  ///< multipliers
inline constexpr std::uint32_t kPhiloxW0 = 0x9E3779B9u, kPhiloxW1 = 0xBB67AE85u;  ///< key increments

/// Philox4x32-10 (Salmon et al. 2011, as in Random123): four random words as a pure function of counter and
/// key. There is no state, so results do not depend on the number of threads or the order of evaluation.
[[gnu::always_inline]] inline void philox(std::uint32_t& c0, std::uint32_t& c1, std::uint32_t& c2,
                                          std::uint32_t& c3, std::uint32_t k0, std::uint32_t k1) {
#pragma GCC unroll 10
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{kPhiloxM0} * c0, p1 = std::uint64_t{kPhiloxM1} * c2;
    c0 = std::uint32_t(p1 >> 32) ^ c1 ^ k0;
    c2 = std::uint32_t(p0 >> 32) ^ c3 ^ k1;
    c1 = std::uint32_t(p1);
    c3 = std::uint32_t(p0);
    k0 += kPhiloxW0;
    k1 += kPhiloxW1;
  }
}

/// Philox for one draw: key = seed, counter = (agent, step, stream, block). core/random/draw_blocks.h lists
/// the purposes of the streams and blocks.
inline std::array<std::uint32_t, 4> draw(std::uint64_t seed, Stream stream, std::uint32_t agent,
                                         std::uint32_t step, std::uint32_t block = 0) {
  std::array<std::uint32_t, 4> c{agent, step, std::uint32_t(stream), block};
  philox(c[0], c[1], c[2], c[3], std::uint32_t(seed), std::uint32_t(seed >> 32));
  return c;
}

/// Uniform in (0, 1), 23 bits: the added 0.5, which excludes 0 and 1, is then exact in a float.
[[gnu::always_inline]] inline float uniform(std::uint32_t word) {
  return (float(word >> 9) + 0.5f) * 0x1p-23f;
}
/// Uniform integer in {0, ..., n-1}, n <= 2^16: multiply-shift, bias below n 2^-32.
[[gnu::always_inline]] inline std::uint32_t below(std::uint32_t word, std::uint32_t n) {
  return std::uint32_t((std::uint64_t{word} * n) >> 32);
}
/// Two independent standard normals from two words (Box-Muller); the tails are cut at 5.8 sigma.
[[gnu::always_inline]] inline std::array<float, 2> normals(std::uint32_t a, std::uint32_t b) {
  const float radius = std::sqrt(-2.0f * portable::log(uniform(a)));
  const auto [s, c] = portable::sincos(float(std::int32_t(b) >> 8) * (portable::kPiF * 0x1p-23f));
  return {radius * c, radius * s};
}

}  // namespace faba
