#pragma once
#include <vector>

#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// Multigrid solver of a FlowSystem: coarser grids of half the size correct the smooth error, for which
/// sweeps on the fine grid alone would need thousands of iterations. V-cycle with two pre-smoothing and two
/// post-smoothing sweeps per grid; with the nine-point mean a sweep reduces the high-frequency error to a
/// third or less. Reuses its memory between solutions. Bit-identical for any pool. T is float or double.
template <class T>
class FlowMultigrid {
 public:
  /// Sets up the coarser grids of `finest`. Called before guess() and cycle().
  void set_up(const FlowSystem<T>& finest, Pool& pool);
  /// Initial guess from the coarsest grid up (full multigrid), written to `w`.
  void guess(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);
  /// One V-cycle. Returns the largest change of a component, px: in the last sweep or in the coarse-grid
  /// correction, whichever is larger.
  T cycle(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);

 private:
  struct Grid {
    FlowSystem<T> system;
    FlowPlanes<T> w, spare;
  };
  T cycle(std::size_t below, const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);

  std::vector<Grid> coarser_;  ///< from fine to coarse, without the finest
};

}  // namespace faba
