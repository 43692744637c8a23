#pragma once
#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#include "core/parallel.h"

namespace faba {

/// A picture of numbers for kernels: every row begins on a 64-byte line and has a margin of a line on either
/// side, so that the neighbours of its first and last pixel can be read without asking where the row ends.
/// Margins hold what was written there last; extend() makes them copies of the border.
template <class T>
class Plane {
 public:
  static constexpr int kMargin = int(64 / sizeof(T));

  Plane() = default;
  /// Holds zeros; sizes in px, 0 or more.
  Plane(int width, int height) { resize(width, height); }
  /// Makes it that size; all zero, unless it has the size already: then everything stays.
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
  /// Pixel (0, row); pixels -kMargin to width + kMargin - 1 are memory of the row.
  T* row(int row) { return data_.data() + stride_ * std::size_t(row) + kMargin; }
  const T* row(int row) const { return data_.data() + stride_ * std::size_t(row) + kMargin; }
  /// The pixels beside both ends of a row become copies of the ends.
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

/// job(begin, end) over shares of the rows [0, height), one to a thread where they are enough to pay.
template <class Job>
void for_rows(int height, Pool& pool, Job&& job) {
  constexpr int kFewRows = 32;  // fewer are not worth waking another thread
  const int shares = std::clamp(height / kFewRows, 1, int(pool.threads()));
  pool.run(std::size_t(shares), [&](std::size_t i) {
    const auto at = [&](std::size_t k) { return int(std::size_t(height) * k / std::size_t(shares)); };
    job(at(i), at(i + 1));
  });
}

}  // namespace faba
