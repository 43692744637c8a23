#include "app/bench/memory.h"

#include <fstream>
#include <string>

namespace faba {

Memory memory_of_machine() {
  std::ifstream in("/proc/meminfo");
  Memory m;
  std::string name, unit;
  for (std::uint64_t kib = 0; m.available == 0 && in >> name >> kib >> unit;) {
    if (name == "MemTotal:") m.total = 1024 * kib;
    if (name == "MemAvailable:") m.available = 1024 * kib;
  }
  return m;
}

}  // namespace faba
