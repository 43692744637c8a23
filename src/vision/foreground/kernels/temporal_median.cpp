#include "vision/foreground/kernels/temporal_median.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/wide.h"

namespace faba {
namespace {

constexpr std::size_t kLongest = 16;  // floats of the longest vector

/// Two places of a list: the smaller value is put into the first one.
struct Exchange {
  std::uint32_t low, high;
};

// Sorts any list of n values: Batcher's merge exchange (Knuth, The Art of Computer Programming, volume 3,
// algorithm 5.2.2 M). The order of the comparisons does not depend on the values: several lists are sorted at
// the same time.
std::vector<Exchange> sorting_network(std::uint32_t n) {
  std::vector<Exchange> network;
  if (n < 2) return network;
  const std::uint32_t most = std::bit_ceil(n) / 2;
  for (std::uint32_t p = most; p > 0; p /= 2) {
    std::uint32_t r = 0, d = p;
    for (std::uint32_t q = most;; q /= 2) {
      for (std::uint32_t i = 0; i + d < n; ++i)
        if ((i & p) == r) network.push_back({i, i + d});
      if (q == p) break;
      d = q - p;
      r = p;
    }
  }
  return network;
}

// The comparisons after which a place of a list of n values that fall and then rise has the value that it has
// in the sorted list: those of a bitonic merge that lead to this place (Knuth, 5.3.4).
std::vector<Exchange> selection_network(std::uint32_t n, std::uint32_t place) {
  std::vector<Exchange> network;
  std::uint32_t begin = 0;  // of the part that has the place
  for (std::uint32_t d = std::bit_ceil(n) / 2; d > 0; d /= 2) {
    for (std::uint32_t i = begin; i < begin + d && i + d < n; ++i) network.push_back({i, i + d});
    if (place >= begin + d) begin += d;
  }
  return network;
}

/// A list of `count` values for each of kLongest pixels: value k of pixel i is values[k * kLongest + i].
struct Lists {
  explicit Lists(std::size_t n)
      : values(n * kLongest),
        count(n),
        middle((n - 1) / 2),
        sorting(sorting_network(std::uint32_t(n))),
        selection(selection_network(std::uint32_t(n), std::uint32_t(middle))) {}

  std::vector<float> values;
  std::size_t count, middle;
  std::vector<Exchange> sorting, selection;
};

// Replaces the values by their deviations, and returns both medians.
template <int bytes>
[[gnu::always_inline]] inline void take_medians_in(Lists& lists, float* median, float* deviation) {
  using V = typename Wide<float, bytes>::type;
  constexpr std::size_t kLanes = std::size_t(bytes) / sizeof(float);
  for (std::size_t first = 0; first < kLongest; first += kLanes) {
    float* const values = lists.values.data() + first;
    const auto at = [values](std::size_t k) -> V& { return *reinterpret_cast<V*>(values + k * kLongest); };
    const auto compare = [&](const std::vector<Exchange>& network) {
      for (const auto& [low, high] : network) {
        const V a = at(low), b = at(high);
        at(low) = a < b ? a : b;
        at(high) = a < b ? b : a;
      }
    };
    compare(lists.sorting);
    const V m = at(lists.middle);
    for (std::size_t k = 0; k < lists.count; ++k) at(k) = at(k) < m ? m - at(k) : at(k) - m;
    compare(lists.selection);
    *reinterpret_cast<V*>(median + first) = m;
    *reinterpret_cast<V*>(deviation + first) = at(lists.middle);
  }
}
FABA_WIDE(take_medians, (Lists & lists, float* median, float* deviation), (lists, median, deviation))

}  // namespace

void temporal_medians(std::span<const CompactImage> frames, std::size_t begin, std::size_t end, GrayF& median,
                      GrayF& deviation) {
  Lists lists(frames.size());
  float medians[kLongest], deviations[kLongest];
  for (std::size_t first = begin; first < end; first += kLongest) {
    const std::size_t n = std::min(kLongest, end - first);
    for (std::size_t k = 0; k < frames.size(); ++k) frames[k].copy(first, n, &lists.values[k * kLongest]);
    take_medians(lists, medians, deviations);
    std::copy_n(medians, n, &median.px[first]);
    std::copy_n(deviations, n, &deviation.px[first]);
  }
}

}  // namespace faba
