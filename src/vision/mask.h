#pragma once
#include <cstdint>
#include <cstring>

namespace faba {

/// Calls visit(i) for each of the n bytes that is not 0, in order. Quick where few are: eight are looked at
/// at once.
template <class Visit>
void each_set(const std::uint8_t* mask, int n, Visit&& visit) {
  int i = 0;
  for (; i + 8 <= n; i += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, mask + i, 8);
    if (eight == 0) continue;
    for (int k = i; k < i + 8; ++k)
      if (mask[k]) visit(k);
  }
  for (; i < n; ++i)
    if (mask[i]) visit(i);
}

}  // namespace faba
