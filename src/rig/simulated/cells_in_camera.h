#pragma once
#include <vector>

#include "core/frame.h"
#include "sim/state.h"
#include "vision/render/kernels/cell_splats.h"

namespace faba {

/// The cells of a simulation as a camera meets them: where they are at mid-exposure, how rods lie, and how
/// far each moves while the shutter is open. The way is a straight line, from the displacement since the
/// moment that remember() was last called.
class CellsInCamera {
 public:
  explicit CellsInCamera(const Frame& frame) : frame_(frame) {}

  /// Keeps the positions as they are now; the next look() reckons velocities from them.
  void remember(const State& s);
  /// Forgets them: the next look() finds all cells at rest.
  void forget() { x_.clear(); }
  /// Image frame, px, in the order of the cells; valid until the next call. `exposure_time` s. Rods lie along
  /// the columns ux, uy where a model has them.
  const std::vector<CameraCell>& look(const State& s, double exposure_time);

 private:
  Frame frame_;
  double t_ = 0;              ///< s, when positions were remembered
  std::vector<float> x_, y_;  ///< m, world
  std::vector<CameraCell> cells_;
};

}  // namespace faba
