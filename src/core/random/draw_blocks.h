#pragma once
#include <array>
#include <cstdint>

#include "core/random/philox.h"

namespace faba {

/// Purpose of a random draw. The counter of Philox is (agent, step, stream, block). Draws for two purposes
/// are independent for any agent and step, because their pairs (stream, block) differ.
struct DrawBlock {
  Stream stream;
  std::uint32_t block;
};

// All purposes of a run. Append only; never renumber. Rows (core/kernels/philox_row.h) have block 0. Purposes
// of studies, in Stream::study, are StudyDraws (study/stats/study_random.h).
inline constexpr DrawBlock kPositionDraws{Stream::start, 0};    ///< initial position of a cell; step: attempt
inline constexpr DrawBlock kBirthDraws{Stream::start, 0xFFFF};  ///< heading, speed and turning rate of a cell
inline constexpr DrawBlock kMotionDraws{Stream::motion, 0};     ///< noise of one step, in rows
inline constexpr DrawBlock kReorientDraws{Stream::motility, 0};   ///< reversals and tumbles
inline constexpr DrawBlock kToleranceDraws{Stream::motility, 1};  ///< tolerated dose of oxygen of a cell
inline constexpr DrawBlock kResponseDraws{Stream::motility, 2};   ///< whether a cell responds to the field
inline constexpr DrawBlock kPixelDraws{Stream::camera, 0};        ///< pixel noise, in rows; step: frame
inline constexpr DrawBlock kFrameDraws{Stream::camera, 1};        ///< agent: a FrameDraw; step: frame
inline constexpr DrawBlock kDepthDraws{Stream::camera, 2};        ///< distance of a cell from focus
inline constexpr DrawBlock kWaveDraws{Stream::camera, 3};         ///< uneven illumination; agent: wave
inline constexpr DrawBlock kPolicyDraws{Stream::camera,
                                        4};  ///< noise of the position that a policy sees; step: frame
inline constexpr DrawBlock kContestDraws{Stream::exclusion, 0};  ///< key of the contests of one step

/// Value used as the agent in kFrameDraws.
enum class FrameDraw : std::uint32_t {
  lamp = 0,  ///< flicker
  time = 1   ///< jitter of the time of exposure
};

namespace draw_blocks {

inline constexpr std::array kAll{kPositionDraws,  kBirthDraws,    kMotionDraws,  kReorientDraws,
                                 kToleranceDraws, kResponseDraws, kPixelDraws,   kFrameDraws,
                                 kDepthDraws,     kWaveDraws,     kContestDraws, kPolicyDraws};

constexpr bool all_differ() {
  for (std::size_t i = 0; i < kAll.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (kAll[i].stream == kAll[j].stream && kAll[i].block == kAll[j].block) return false;
  return true;
}

static_assert(all_differ());

}  // namespace draw_blocks

/// One draw for a purpose.
inline std::array<std::uint32_t, 4> draw(std::uint64_t seed, DrawBlock purpose, std::uint32_t agent,
                                         std::uint32_t step) {
  return draw(seed, purpose.stream, agent, step, purpose.block);
}

}  // namespace faba
