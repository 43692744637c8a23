#pragma once

namespace faba {

/// Whether one of `n` values is above `threshold`, or above `threshold` times its weight if there are
/// weights.
bool any_above(const float* values, const float* weights, float threshold, int n);

}  // namespace faba
