#include "vision/image/patches.h"

#include <cstddef>

#include "vision/image/mask.h"

namespace faba {

int connected_components(const std::vector<std::uint8_t>& mask, int width, int height,
                         std::vector<ComponentRun>& runs) {
  runs.clear();
  // Union-find forest: until the final numbering, `patch` is the index of an earlier run of the same
  // component, or of the run itself.
  const auto root = [&](int k) {
    auto* r = &runs[std::size_t(k)];
    while (r->patch != k) {
      r->patch = runs[std::size_t(r->patch)].patch;  // path compression
      k = r->patch;
      r = &runs[std::size_t(k)];
    }
    return k;
  };
  int above = 0, above_end = 0;  // runs of the row above that may still be connected
  for (int row = 0; row < height; ++row) {
    const int row_begin = int(runs.size());
    each_run(mask.data() + std::size_t(row) * std::size_t(width), width, [&](int first, int end) {
      const int index = int(runs.size());
      runs.push_back({row, first, end, index});
      while (above < above_end && runs[std::size_t(above)].end < first) ++above;
      for (int k = above; k < above_end && runs[std::size_t(k)].first <= end; ++k) {
        const int a = root(k), b = root(index);
        if (a < b)
          runs[std::size_t(b)].patch = a;
        else
          runs[std::size_t(a)].patch = b;
      }
    });
    above = row_begin;
    above_end = int(runs.size());
  }
  // The root precedes all other runs of its component, so it is already numbered.
  int patches = 0;
  for (std::size_t k = 0; k < runs.size(); ++k)
    runs[k].patch = runs[k].patch == int(k) ? patches++ : runs[std::size_t(runs[k].patch)].patch;
  return patches;
}

}  // namespace faba
