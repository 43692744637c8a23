#include "sim/sites.h"

#include "core/vectorised.h"
#include "sim/arena.h"

namespace faba {
namespace {

FABA_VECTORISED void find(const Grid& g, const float* x, const float* y, std::size_t n,
                          std::int32_t* __restrict site) {
  const Grid grid = g;
  for (std::size_t i = 0; i < n; ++i) site[i] = grid.index(x[i], y[i]);
}

}  // namespace

void find_sites(const Grid& grid, std::span<const float> x, std::span<const float> y, std::int32_t* site) {
  find(grid, x.data(), y.data(), x.size(), site);
}

}  // namespace faba
