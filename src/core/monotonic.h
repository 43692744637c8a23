#pragma once
#include <ctime>

namespace faba {

/// s on the clock that all processes of this machine share and nobody sets.
inline double monotonic_now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace faba
