#pragma once
#include <cstdint>

namespace faba {

/// Physical memory, bytes.
struct Memory {
  std::uint64_t total = 0;
  std::uint64_t available = 0;  ///< for new data without swapping
};
/// That of this machine, from /proc/meminfo; zeros if it cannot be read.
Memory memory_of_machine();

}  // namespace faba
