#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random/philox.h"

namespace faba {

/// Purposes of the random numbers of a study: blocks of Stream::study, so that two purposes have no numbers
/// in common for any seeds. Append only; never renumber.
enum class StudyDraws : std::uint32_t {
  posterior = 1,        ///< Markov chain
  prediction = 2,       ///< noise of predicted statistics
  bootstrap = 3,        ///< resampling of experiments
  timing = 9,           ///< start times of field segments
  measurement = 10,     ///< measurement noise added to statistics of simulations
  apparatus = 11,       ///< errors of the stated scale, field strength and number of cells
  u_turn = 12,          ///< simulated U-turns and their resampling
  truth = 13,           ///< true parameters of a calibration
  reference = 14,       ///< reference points and ties of a calibration
  first_proposal = 100  ///< parameters of search round 0; round n has first_proposal + n
};

/// Sequence of random numbers of a study: reproducible for a seed and purpose.
class StudyRandom {
 public:
  StudyRandom(std::uint64_t seed, StudyDraws purpose) : seed_(seed), purpose_(std::uint32_t(purpose)) {}

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
  /// Uniform on 0 ... n - 1.
  std::size_t below(std::size_t n) { return std::size_t(uniform() * double(n)) % n; }

 private:
  std::uint64_t seed_, next_ = 0;
  std::uint32_t purpose_;
};

}  // namespace faba
