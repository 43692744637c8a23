#pragma once
#include <cstdlib>

namespace faba {

/// Index of one of `n` pixels, mirrored at the first and the last one, for any distance.
inline int mirrored(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  i = std::abs(i) % period;
  return i < n ? i : period - i;
}

}  // namespace faba
