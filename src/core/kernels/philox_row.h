#pragma once
#include <algorithm>
#include <span>

#include "core/random/philox.h"

namespace faba {

/// Random words of consecutive agents as a structure of arrays, for vectorised loops over agents.
struct PhiloxRow {
  static constexpr std::size_t kLength =
      256;  ///< 4 KiB: fits into the L1 cache together with a block of agents
  alignas(64) std::array<std::uint32_t, kLength> w0, w1, w2, w3;
};

/// draw() with block 0 for agents [first, first + n), n <= PhiloxRow::kLength, with the widest vector
/// multiplier of the processor, which compilers do not use for a product of two words. Elements beyond n are
/// undefined.
void draw_row(std::uint64_t seed, Stream stream, std::uint32_t first, std::uint32_t step, std::size_t n,
              PhiloxRow& row);

/// One implementation of a row. All give the same words.
struct PhiloxKernel {
  const char* instructions;
  void (*row)(std::uint32_t first, std::uint32_t step, std::uint32_t stream, std::uint64_t seed,
              std::size_t n, PhiloxRow& row);
};
/// Implementations that this machine supports, the fastest first.
std::span<const PhiloxKernel> philox_kernels();

/// Calls job(i, n, row) for the rows of agents [begin, begin + count): the words of agent begin + i + j are
/// row.w0[j] ... row.w3[j], j < n.
template <class Job>
void for_rows(std::uint64_t seed, Stream stream, std::size_t begin, std::size_t count, std::uint32_t step,
              Job&& job) {
  PhiloxRow row;
  for (std::size_t i = 0; i < count; i += PhiloxRow::kLength) {
    const std::size_t n = std::min(PhiloxRow::kLength, count - i);
    draw_row(seed, stream, std::uint32_t(begin + i), step, n, row);
    job(i, n, row);
  }
}

}  // namespace faba
