#include "app/run/random_seed.h"

#include <random>

namespace faba {

std::uint64_t random_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32 | device()) & 0xFFFFFFFFFFFFull;
}

}  // namespace faba
