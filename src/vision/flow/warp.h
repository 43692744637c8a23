#pragma once
#include "vision/flow/kernels/flow_system.h"

namespace faba {

/// `b` as it would look had nothing moved: out(x) = b(x + w(x)), by cubic interpolation (Keys 1981, a =
/// -1/2). Where that lies outside of `b` it is NaN. All of one size.
template <class T>
void warp(const Plane<T>& b, const FlowPlanes<T>& w, Plane<T>& out, Pool& pool);

}  // namespace faba
