#include "vision/image/kernels/frame_change.h"

#include <numeric>
#include <vector>

#include "core/vectorised.h"

namespace faba {
namespace {

/// Sums over the rows, of each column.
struct ColumnSums {
  std::vector<float> mean, squared, slope, gradient;
  explicit ColumnSums(std::size_t n) : mean(n), squared(n), slope(n), gradient(n) {}
};

FABA_VECTORISED void subtract_row(const float* a, const float* b, float* out, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] = a[i] - b[i];
}

FABA_VECTORISED void add_values(const float* row, float* sum, float* squares, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) {
    sum[i] += row[i];
    squares[i] += row[i] * row[i];
  }
}

FABA_VECTORISED void add_gradients(const float* above, const float* row, const float* below, float* squares,
                                   int n) {
  FABA_ELEMENTWISE
  for (int i = 1; i < n - 1; ++i) {
    const float x = 0.5F * (row[i + 1] - row[i - 1]), y = 0.5F * (below[i] - above[i]);
    squares[i] += x * x + y * y;
  }
}

double inner_sum(const std::vector<float>& columns) {
  return std::accumulate(columns.begin() + 1, columns.end() - 1, 0.0);
}

}  // namespace

FrameChange frame_change(const GrayF& before, const GrayF& frame) {
  const int w = frame.width;
  const auto n = std::size_t(w);
  const auto row = [n](const GrayF& picture, int r) { return &picture.px[std::size_t(r) * n]; };
  ColumnSums sums(n);
  std::vector<float> changes(3 * n);  // of three rows
  const auto change = [&](int r) { return &changes[std::size_t(r % 3) * n]; };
  for (int r = 0; r < 2; ++r) subtract_row(row(frame, r), row(before, r), change(r), w);
  for (int r = 1; r + 1 < frame.height; ++r) {
    subtract_row(row(frame, r + 1), row(before, r + 1), change(r + 1), w);
    add_values(change(r), sums.mean.data(), sums.squared.data(), w);
    add_gradients(change(r - 1), change(r), change(r + 1), sums.slope.data(), w);
    add_gradients(row(frame, r - 1), row(frame, r), row(frame, r + 1), sums.gradient.data(), w);
  }
  const double inner = double(w - 2) * (frame.height - 2);
  return {inner_sum(sums.mean) / inner, inner_sum(sums.squared) / inner, inner_sum(sums.slope) / inner,
          inner_sum(sums.gradient) / inner};
}

}  // namespace faba
