#pragma once
#include <vector>

#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// Solves a FlowSystem to the end: grids of half the size each carry the corrections that sweeps on the fine
/// one would take thousands of to bring about. On each grid two sweeps before and two after the coarser ones;
/// the nine-point mean lets a sweep leave a third or less of what only this grid can see. Keeps its memory
/// from one solution to the next. Same bits for any pool. T is float or double.
template <class T>
class FlowMultigrid {
 public:
  /// The coarser grids of `finest`, from where all solutions start.
  void set_up(const FlowSystem<T>& finest, Pool& pool);
  /// A first guess from the coarsest grid up into `w`, which it replaces.
  void guess(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);
  /// One cycle; returns the largest change of a component that it made (its last sweep or the correction from
  /// the coarser grids, whichever is larger), px.
  T cycle(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);

 private:
  struct Grid {
    FlowSystem<T> system;
    FlowPlanes<T> w, spare;
  };
  T cycle(std::size_t below, const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool);

  std::vector<Grid> coarser_;  ///< from the next coarser one down
};

}  // namespace faba
