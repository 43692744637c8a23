#pragma once
#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// Warps `b` backwards by the flow w: out(x) = b(x + w(x)), cubic interpolation (Keys 1981, a = -1/2).
/// Positions outside `b` give NaN. All planes have the same size.
template <class T>
void warp(const Plane<T>& b, const FlowPlanes<T>& w, Plane<T>& out, Pool& pool);

}  // namespace faba
