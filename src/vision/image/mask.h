#pragma once
#include <cstdint>
#include <cstring>

namespace faba {

/// Calls visit(i) for each non-zero byte of n, in order. Fast for sparse masks: eight bytes are tested at
/// once.
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

/// Calls visit(first, end) for each run of non-zero bytes, in order.
template <class Visit>
void each_run(const std::uint8_t* mask, int n, Visit&& visit) {
  int i = 0;
  const auto skip = [&](std::uint64_t like) {
    for (std::uint64_t eight = 0; i + 8 <= n; i += 8) {
      std::memcpy(&eight, mask + i, 8);
      if (eight != like) return;
    }
  };
  while (i < n) {
    skip(0);
    while (i < n && mask[i] == 0) ++i;
    if (i == n) return;
    const int first = i;
    skip(0x0101010101010101);
    while (i < n && mask[i] != 0) ++i;
    visit(first, i);
  }
}

}  // namespace faba
