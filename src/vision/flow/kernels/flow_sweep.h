#pragma once
#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// `count` >= 1 Jacobi sweeps over the grid. `w` is the initial value and the result; `spare` has the same
/// size, its content is undefined afterwards. Several sweeps are interleaved row by row to stay in the cache.
/// Returns the largest change of a component in the last sweep, px, or 0 without `watch`. Bit-identical for
/// any pool. T is float or double.
template <class T>
T sweep(const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare, int count, bool watch, Pool& pool);

}  // namespace faba
