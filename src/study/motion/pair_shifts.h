#pragma once
#include <array>
#include <vector>

#include "core/vec.h"
#include "study/motion/response_frames.h"

namespace faba {

/// Measures of the mean displacement of the objects between two frames.
enum class ShiftMeasure {
  centroid,  ///< shift of the centroid of the objects: for a swarm with free space around it
  fine,      ///< registration on a scale of 4 px: for slow objects in the entire picture
  coarse     ///< on a scale of 18 px
};
inline constexpr std::array kShiftMeasures{ShiftMeasure::centroid, ShiftMeasure::fine, ShiftMeasure::coarse};
const char* word_of(ShiftMeasure measure);

/// Displacements between consecutive frames, in px of the video (x right, y down).
struct PairShifts {
  std::vector<double> t0_s, t1_s;
  std::array<std::vector<Vec2>, kShiftMeasures.size()> by;  ///< of each measure, per pair

  std::size_t size() const { return t0_s.size(); }
  const std::vector<Vec2>& of(ShiftMeasure measure) const { return by[std::size_t(measure)]; }
};

/// The registration compares a picture B, band-passed between the size of an object and 12 px, with the
/// gradient of the next one smoothed on the scale R, S = G_R * B (theory A16):
///   u_k = sum(B_k grad S_(k+1) - B_(k+1) grad S_k) / sum(grad B . grad S),
/// the mean displacement of objects that move by less than R. What does not move contributes nothing, and
/// noise, which is independent between frames, has zero mean. Displacements of different objects are averaged
/// with the weight of their contrast.
PairShifts pair_shifts(const ResponseFrames& frames, const VideoPart& part);

}  // namespace faba
