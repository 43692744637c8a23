#pragma once
#include <ctime>

namespace faba {

/// Monotonic time in s, the same for all processes of this machine.
inline double monotonic_now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace faba
