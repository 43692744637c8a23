#include "vision/image/patches.h"

#include <doctest/doctest.h>

#include <random>

using namespace faba;

namespace {

// Reference: component of each pixel by flood fill, or -1; components in the order of their first pixels.
std::vector<int> walked(const std::vector<std::uint8_t>& mask, int w, int h, int& patches) {
  std::vector<int> of(mask.size(), -1);
  patches = 0;
  for (int start = 0; start < w * h; ++start) {
    if (!mask[std::size_t(start)] || of[std::size_t(start)] >= 0) continue;
    std::vector<int> open{start};
    of[std::size_t(start)] = patches;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      for (int row = at / w - 1; row <= at / w + 1; ++row)
        for (int col = at % w - 1; col <= at % w + 1; ++col) {
          if (row < 0 || row >= h || col < 0 || col >= w) continue;
          const auto i = std::size_t(row * w + col);
          if (mask[i] && of[i] < 0) {
            of[i] = patches;
            open.push_back(int(i));
          }
        }
    }
    ++patches;
  }
  return of;
}

}  // namespace

TEST_CASE("connected components match a flood fill for random masks") {
  std::mt19937 random(1);
  std::vector<ComponentRun> runs;
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {40, 1}, {7, 9}, {64, 48}, {133, 71}})
    for (const double share : {0.0, 0.05, 0.3, 0.42, 0.6, 0.9, 1.0}) {
      INFO(w, " x ", h, ", covered ", share);
      std::vector<std::uint8_t> mask(std::size_t(w) * std::size_t(h));
      std::bernoulli_distribution covered(share);
      for (auto& m : mask) m = covered(random) ? 1 : 0;
      int expected = 0;
      const std::vector<int> truth = walked(mask, w, h, expected);
      CHECK(connected_components(mask, w, h, runs) == expected);
      std::vector<int> found(mask.size(), -1);
      for (const ComponentRun& r : runs) {
        REQUIRE(r.first < r.end);
        for (int i = r.first; i < r.end; ++i) found[std::size_t(r.row * w + i)] = r.patch;
      }
      CHECK(found == truth);
    }
}
