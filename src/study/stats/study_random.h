#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/philox.h"

namespace faba {

/// Random numbers of a study, one after the other: the same for the same seed and purpose, whatever ran
/// before.
class StudyRandom {
 public:
  StudyRandom(std::uint64_t seed, std::uint32_t purpose) : seed_(seed), purpose_(purpose) {}

  /// In (0, 1), 53 bits.
  double uniform() {
    const auto w = draw(seed_, Stream::study, std::uint32_t(next_), std::uint32_t(next_ >> 32), purpose_);
    ++next_;
    return (double(w[0] >> 5) * 0x1p26 + double(w[1] >> 6) + 0.5) * 0x1p-53;
  }
  /// Standard normal (Box-Muller).
  double normal() {
    const double r = std::sqrt(-2 * std::log(uniform()));
    return r * std::cos(2 * std::numbers::pi * uniform());
  }
  /// One of 0 ... n - 1.
  std::size_t below(std::size_t n) { return std::size_t(uniform() * double(n)) % n; }

 private:
  std::uint64_t seed_, next_ = 0;
  std::uint32_t purpose_;
};

}  // namespace faba
