#include "core/random/splitmix64.h"

#include <doctest/doctest.h>

#include <initializer_list>

// The first numbers of the published generator with seed 1234567.
TEST_CASE("SplitMix64: the numbers of the reference implementation") {
  std::uint64_t state = 1234567;
  for (const std::uint64_t expected : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u})
    CHECK(faba::splitmix64(state += faba::kSplitMix64Step) == expected);
}
