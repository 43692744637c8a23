#pragma once
#include <vector>

#include "core/frame.h"
#include "sim/state.h"
#include "vision/render/kernels/cell_splats.h"

namespace faba {

/// Cells of a simulation as seen by a camera: positions at mid-exposure, orientations of rods, and
/// displacements during the exposure, assumed linear, from the velocity since the last remember().
class CellsInCamera {
 public:
  explicit CellsInCamera(const Frame& frame) : frame_(frame) {}

  /// Stores the present positions; the next look() computes velocities from them.
  void remember(const State& s);
  /// Clears the stored positions: the next look() returns zero velocities.
  void forget() { x_.clear(); }
  /// Cells in the image frame, px, in order; valid until the next call. `exposure_time` in s. Orientations
  /// come from the columns ux, uy if the model has them.
  const std::vector<CameraCell>& look(const State& s, double exposure_time);

 private:
  Frame frame_;
  double t_ = 0;              ///< s, time of the stored positions
  std::vector<float> x_, y_;  ///< m, world
  std::vector<CameraCell> cells_;
};

}  // namespace faba
