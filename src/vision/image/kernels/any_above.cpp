#include "vision/image/kernels/any_above.h"

#include "core/vectorised.h"

namespace faba {
namespace {

FABA_VECTORISED int count_above(const float* values, float threshold, int n) {
  int count = 0;
  for (int i = 0; i < n; ++i) count += values[i] > threshold ? 1 : 0;
  return count;
}

FABA_VECTORISED int count_above_weighted(const float* values, const float* weights, float threshold, int n) {
  int count = 0;
  for (int i = 0; i < n; ++i) count += values[i] > threshold * weights[i] ? 1 : 0;
  return count;
}

FABA_VECTORISED int count_longer(const float* u, const float* v, float squared, int n) {
  int count = 0;
  for (int i = 0; i < n; ++i) count += u[i] * u[i] + v[i] * v[i] > squared ? 1 : 0;
  return count;
}

}  // namespace

bool any_above(const float* values, const float* weights, float threshold, int n) {
  return (weights ? count_above_weighted(values, weights, threshold, n) : count_above(values, threshold, n)) >
         0;
}

bool any_longer(const float* u, const float* v, float squared, int n) {
  return count_longer(u, v, squared, n) > 0;
}

}  // namespace faba
