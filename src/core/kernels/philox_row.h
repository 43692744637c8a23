#pragma once
#include <algorithm>
#include <span>

#include "core/philox.h"

namespace faba {

/// The words of agents in a row, word by word, as loops over agents want them.
struct PhiloxRow {
  static constexpr std::size_t kLength = 256;  ///< 4 KiB: stays in the first cache beside a block of agents
  alignas(64) std::array<std::uint32_t, kLength> w0, w1, w2, w3;
};

/// draw() with block 0 for agents [first, first + n), n <= PhiloxRow::kLength, with the processor's widest
/// multiplier: compilers do not find it for a product of two words on their own. What stands beyond n is
/// undefined.
void draw_row(std::uint64_t seed, Stream stream, std::uint32_t first, std::uint32_t step, std::size_t n,
              PhiloxRow& row);

/// One way to compute a row. All give the same words.
struct PhiloxKernel {
  const char* instructions;
  void (*row)(std::uint32_t first, std::uint32_t step, std::uint32_t stream, std::uint64_t seed,
              std::size_t n, PhiloxRow& row);
};
/// Those that this machine can run, the fastest one first.
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
