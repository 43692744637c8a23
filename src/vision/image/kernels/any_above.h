#pragma once

namespace faba {

/// Whether one of `n` values is above `threshold`, or above `threshold` times its weight if there are
/// weights.
bool any_above(const float* values, const float* weights, float threshold, int n);

/// Whether the squared length of one of `n` vectors (u, v) is above `squared`.
bool any_longer(const float* u, const float* v, float squared, int n);

}  // namespace faba
