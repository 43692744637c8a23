#pragma once
#include <cstdint>
#include <vector>

#include "vision/cells/tracker.h"

namespace faba {

inline constexpr double kSimulatedReversal_s = 1e3;  ///< time of the reversal in simulated_u_turns(), s
/// Tracks of dipoles with the turning rate `rate` (1/s) and rotational diffusion `disorder` * rate whose
/// field reverses at kSimulatedReversal_s: planar, unit speed, `noise` as in UTurnSurvey. For the bias of
/// find_u_turns().
std::vector<Track> simulated_u_turns(double rate, double disorder, double noise, double frame_s,
                                     double after_s, std::size_t cells, std::uint64_t seed);

}  // namespace faba
