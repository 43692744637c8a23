#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// A pixel of a picture of which few pixels are not zero.
struct SparsePixel {
  int col = 0, row = 0;
  float value = 0;
};

/// Sums of products of the pixels of two pictures against the displacement between them.
class CorrelationSums {
 public:
  explicit CorrelationSums(int radius) : radius_(radius), sums_(std::size_t(stride() * (2 * radius + 1))) {}
  float at(int dx, int dy) const {
    const std::ptrdiff_t row = dy + radius_, column = dx + radius_;
    return sums_[std::size_t(row * stride() + column)];
  }
  float* data() { return sums_.data(); }
  /// Number of columns, a multiple of kPadding.
  int stride() const { return (2 * radius_ + kPadding) / kPadding * kPadding; }

  static constexpr int kPadding = 16;  ///< columns that are computed at a time

 private:
  int radius_;
  std::vector<float> sums_;
};

/// The displacements for which pictures are correlated.
class CorrelationWindow {
 public:
  /// Empty, for displacements up to `radius` px in each direction.
  explicit CorrelationWindow(int radius) : radius_(radius), rows_(std::size_t(2 * radius + 1)) {}
  void include(int dx, int dy);
  /// Sums over the pixels of the first picture. Values of displacements outside the window are undefined.
  CorrelationSums sums(std::span<const SparsePixel> first, const GrayF& second) const;

 private:
  struct Row {
    int from = 0, to = -1;  // columns of the sums
  };
  int radius_;
  std::vector<Row> rows_;
};

}  // namespace faba
