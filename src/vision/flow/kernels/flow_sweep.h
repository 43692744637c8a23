#pragma once
#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// `count` >= 1 sweeps of the system's iteration over the whole grid, all pixels from the sweep before
/// (Jacobi). `w` is both start and result; `spare` has the same size and is left in disorder. Several sweeps
/// go over the rows together, while these are in the cache. Returns the largest change of a component in the
/// last sweep, px, or 0 without `watch`. Same bits for any pool. T is float or double.
template <class T>
T sweep(const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare, int count, bool watch, Pool& pool);

}  // namespace faba
