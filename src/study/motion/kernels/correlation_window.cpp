#include "study/motion/kernels/correlation_window.h"

#include <algorithm>

#include "core/vectorised.h"

namespace faba {
namespace {

constexpr int kAtOnce = CorrelationSums::kPadding;

/// Columns of one row of displacements, in groups of kAtOnce.
struct Groups {
  int row = 0, first = 0, count = 0;
};

struct Pictures {
  const float* second;  ///< with a border of zeros
  int width;            ///< with the border
};

FABA_VECTORISED void add_products(const SparsePixel* pixels, std::size_t n, const Pictures& p,
                                  const Groups* groups, std::size_t rows, float* sums, int stride) {
  for (std::size_t k = 0; k < n; ++k) {
    const float value = pixels[k].value;
    for (std::size_t g = 0; g < rows; ++g) {
      const float* other = p.second + std::ptrdiff_t(pixels[k].row + groups[g].row) * p.width +
                           pixels[k].col + groups[g].first;
      float* sum = sums + std::ptrdiff_t(groups[g].row) * stride + groups[g].first;
      for (int i = 0; i < groups[g].count; ++i, other += kAtOnce, sum += kAtOnce) {
        FABA_ELEMENTWISE
        for (int c = 0; c < kAtOnce; ++c) sum[c] += value * other[c];
      }
    }
  }
}

}  // namespace

void CorrelationWindow::include(int dx, int dy) {
  const int line = dy + radius_, column = dx + radius_;
  Row& row = rows_[std::size_t(line)];
  row = row.to < row.from ? Row{column, column} : Row{std::min(row.from, column), std::max(row.to, column)};
}

CorrelationSums CorrelationWindow::sums(std::span<const SparsePixel> first, const GrayF& second) const {
  CorrelationSums out(radius_);
  std::vector<Groups> groups;
  for (int r = 0; r < int(rows_.size()); ++r) {
    const Row& row = rows_[std::size_t(r)];
    if (row.to < row.from) continue;
    const int count = (row.to - row.from) / kAtOnce + 1;
    groups.push_back({r, std::min(row.from, out.stride() - count * kAtOnce), count});
  }
  // Pixel (0, 0) of the border belongs to the displacement (-radius, -radius) of pixel (0, 0).
  const int width = second.width + out.stride(), height = second.height + 2 * radius_;
  std::vector<float> padded(std::size_t(width) * std::size_t(height));
  for (int r = 0; r < second.height; ++r)
    std::copy_n(&second.px[std::size_t(r) * std::size_t(second.width)], second.width,
                &padded[std::size_t(r + radius_) * std::size_t(width) + std::size_t(radius_)]);
  add_products(first.data(), first.size(), {padded.data(), width}, groups.data(), groups.size(), out.data(),
               out.stride());
  return out;
}

}  // namespace faba
