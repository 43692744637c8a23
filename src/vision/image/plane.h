#pragma once
#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#include "core/threads/parallel.h"

namespace faba {

/// A padded picture for kernels: every row starts at a 64-byte boundary and has a margin of 64 bytes on both
/// sides, so kernels can read the neighbours of the first and last pixel without a bounds check. Margins keep
/// the last values written; extend() copies the border pixels to them.
template <class T>
class Plane {
 public:
  static constexpr int kMargin = int(64 / sizeof(T));

  Plane() = default;
  /// Initialised with zeros; sizes in px, >= 0.
  Plane(int width, int height) { resize(width, height); }
  /// Resizes and sets all values to zero; no effect if the size is unchanged.
  void resize(int width, int height) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    stride_ = std::size_t((width + kMargin - 1) / kMargin + 2) * std::size_t(kMargin);
    data_.assign(stride_ * std::size_t(height), T{});
  }
  void clear() { std::fill(data_.begin(), data_.end(), T{}); }
  void clear_row(int r) { std::fill(row(r), row(r) + width_, T{}); }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Pixel (0, row); pixels -kMargin to width + kMargin - 1 can be accessed.
  T* row(int row) { return data_.data() + stride_ * std::size_t(row) + kMargin; }
  const T* row(int row) const { return data_.data() + stride_ * std::size_t(row) + kMargin; }
  /// Copies the first and last pixel of a row to the adjacent margin pixels.
  void extend(int r) {
    T* p = row(r);
    p[-1] = p[0];
    p[width_] = p[width_ - 1];
  }

 private:
  template <class U>
  struct Aligned {
    using value_type = U;
    Aligned() = default;
    template <class V>
    explicit Aligned(const Aligned<V>&) {}
    U* allocate(std::size_t n) {
      return static_cast<U*>(::operator new (n * sizeof(U), std::align_val_t{64}));
    }
    void deallocate(U* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
    friend bool operator==(const Aligned&, const Aligned&) { return true; }
  };
  int width_ = 0, height_ = 0;
  std::size_t stride_ = 0;
  std::vector<T, Aligned<T>> data_;
};

/// Calls job(begin, end) for contiguous parts of the rows [0, height), at most one part per thread.
template <class Job>
void for_rows(int height, Pool& pool, Job&& job) {
  constexpr int kFewRows = 32;  // minimum number of rows per thread
  const int parts = std::clamp(height / kFewRows, 1, int(pool.threads()));
  pool.run(std::size_t(parts), [&](std::size_t i) {
    const auto at = [&](std::size_t k) { return int(std::size_t(height) * k / std::size_t(parts)); };
    job(at(i), at(i + 1));
  });
}

}  // namespace faba
