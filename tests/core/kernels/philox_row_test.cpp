#include "core/kernels/philox_row.h"

#include <doctest/doctest.h>

#include <string>

using namespace faba;

TEST_CASE("every kernel gives the words of draw(), for all row lengths") {
  constexpr std::uint64_t kSeed = 0x0123456789abcdefu;
  for (const PhiloxKernel& kernel : philox_kernels()) {
    INFO(std::string(kernel.instructions));
    PhiloxRow row;
    for (std::size_t n : {1u, 2u, 7u, 8u, 15u, 16u, 17u, 100u, 255u, 256u}) {
      const std::uint32_t first = 4294967295u - 100u, step = 77;  // agent numbers wrap within the row
      kernel.row(first, step, std::uint32_t(Stream::motion), kSeed, n, row);
      for (std::size_t i = 0; i < n; ++i) {
        const auto w = draw(kSeed, Stream::motion, first + std::uint32_t(i), step);
        REQUIRE(w == std::array<std::uint32_t, 4>{row.w0[i], row.w1[i], row.w2[i], row.w3[i]});
      }
    }
  }
}

TEST_CASE("for_rows() covers every agent once") {
  std::size_t next = 0;
  for_rows(5, Stream::motility, 10, 1000, 3, [&](std::size_t i, std::size_t n, const PhiloxRow& row) {
    CHECK(i == next);
    for (std::size_t j = 0; j < n; ++j)
      REQUIRE(row.w2[j] == draw(5, Stream::motility, std::uint32_t(10 + i + j), 3)[2]);
    next += n;
  });
  CHECK(next == 1000);
}
