#pragma once
#include <cstdint>

namespace faba {

/// Increment of the state of the generator SplitMix64: 2^64 divided by the golden ratio.
inline constexpr std::uint64_t kSplitMix64Step = 0x9E3779B97F4A7C15u;

/// Output function of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): a bijection of 64-bit numbers in which
/// every bit of the result depends on every bit of z.
constexpr std::uint64_t splitmix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace faba
