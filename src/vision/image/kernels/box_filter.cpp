#include "vision/image/kernels/box_filter.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/vectorised.h"
#include "core/wide.h"
#include "vision/image/kernels/mirrored.h"

namespace faba {
namespace {

// A running sum waits for its last addition, so the sums of several rows are computed at the same time.
constexpr int kRows = 16;

using Four = float __attribute__((vector_size(16)));

struct Square {
  Four row[4];
};

[[gnu::always_inline]] inline Square transposed(const Square& s) {
  const Four a = __builtin_shufflevector(s.row[0], s.row[1], 0, 4, 1, 5);
  const Four b = __builtin_shufflevector(s.row[2], s.row[3], 0, 4, 1, 5);
  const Four c = __builtin_shufflevector(s.row[0], s.row[1], 2, 6, 3, 7);
  const Four d = __builtin_shufflevector(s.row[2], s.row[3], 2, 6, 3, 7);
  return {{__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
           __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)}};
}

// Pixels have no alignment beyond that of a float; compilers make one instruction of each copy.
Four four(const float* at) {
  Four v;
  std::memcpy(&v, at, sizeof v);
  return v;
}
void put(const Four& v, float* at) { std::memcpy(at, &v, sizeof v); }

using Rows = std::array<float*, kRows>;

// Calls block(row, col) for the 4 x 4 blocks of kRows rows, in an order that uses every cache line at once,
// and rest(col) for the columns that remain.
template <class Block, class Rest>
[[gnu::always_inline]] inline void each_block(int width, Block&& block, Rest&& rest) {
  const int even = width / 4 * 4;
  for (int first = 0; first < even; first += kRows)
    for (int row = 0; row < kRows; row += 4)
      for (int col = first; col < std::min(first + kRows, even); col += 4) block(row, col);
  for (int col = even; col < width; ++col) rest(col);
}

// Place of a pixel among columns of kRows rows.
std::size_t place(int row, int col) { return std::size_t(col) * kRows + std::size_t(row); }

void rows_to_columns(const Rows& rows, int width, float* columns) {
  each_block(
      width,
      [&](int row, int col) {
        Square s;
        for (int i = 0; i < 4; ++i) s.row[i] = four(rows[std::size_t(row) + std::size_t(i)] + col);
        s = transposed(s);
        for (int i = 0; i < 4; ++i) put(s.row[i], columns + place(row, col + i));
      },
      [&](int col) {
        for (int row = 0; row < kRows; ++row) columns[place(row, col)] = rows[std::size_t(row)][col];
      });
}

void columns_to_rows(float* columns, int width, const Rows& rows) {
  each_block(
      width,
      [&](int row, int col) {
        Square s;
        for (int i = 0; i < 4; ++i) s.row[i] = four(columns + place(row, col + i));
        s = transposed(s);
        for (int i = 0; i < 4; ++i) put(s.row[i], rows[std::size_t(row) + std::size_t(i)] + col);
      },
      [&](int col) {
        for (int row = 0; row < kRows; ++row) rows[std::size_t(row)][col] = columns[place(row, col)];
      });
}

// `columns` has the pixels of kRows rows, column after column, from `half` before the first pixel on.
// Replaces column i by the mean about pixel i.
template <int bytes>
[[gnu::always_inline]] inline void running_means_in(float* columns, int width, int half) {
  using Sum = typename Wide<double, bytes>::type;
  using Px = typename Wide<float, bytes / 2>::type;
  constexpr std::size_t kLanes = std::size_t(bytes) / sizeof(double), kSums = kRows / kLanes;
  const auto px = [](float* column, std::size_t k) -> Px& {
    return *reinterpret_cast<Px*>(column + k * kLanes);
  };
  const double weight = 1.0 / (2 * half + 1);
  const std::size_t reach = std::size_t(2 * half + 1) * kRows;
  Sum sum[kSums] = {};
  for (float* at = columns; at < columns + reach; at += kRows)
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kSums; ++k) sum[k] += __builtin_convertvector(px(at, k), Sum);
  float* leaving = columns;
  for (int i = 0; i < width; ++i, leaving += kRows) {
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kSums; ++k) {
      const Px old = px(leaving, k);
      px(leaving, k) = __builtin_convertvector(sum[k] * weight, Px);
      sum[k] += __builtin_convertvector(px(leaving + reach, k), Sum) - __builtin_convertvector(old, Sum);
    }
  }
}
FABA_WIDE(running_means, (float* columns, int width, int half), (columns, width, half))

FABA_VECTORISED void add_row(const float* row, double* sum, int n) {
  for (int i = 0; i < n; ++i) sum[i] += double(row[i]);
}

FABA_VECTORISED void next_row(const float* entering, const float* leaving, double weight, double* sum,
                              float* out, int n) {
  for (int i = 0; i < n; ++i) {
    out[i] = float(sum[i] * weight);
    sum[i] += double(entering[i]) - double(leaving[i]);
  }
}

// Several filters along the rows, then the same along the columns, in place.
class BoxFilter {
 public:
  BoxFilter(GrayF& picture, int half)
      : picture_(picture),
        half_(half),
        kept_(std::min(picture.height, 2 * half + 2 + kRows)),
        means_(std::size_t(kept_) * width()),
        columns_((width() + std::size_t(2 * half + 1)) * kRows),
        dropped_(width()),
        sums_(width()) {}

  // The means along rows are kept for the rows that the first means along columns still need.
  void run(int times) {
    run([&](int end) { mean_rows(end, times); });
    for (int i = 1; i < times; ++i) run([&](int end) { copy_rows(end); });
  }

 private:
  // Means along columns of the rows that fill(end) has put into means_, up to row `end`.
  template <class Fill>
  void run(Fill&& fill) {
    const int h = picture_.height;
    done_ = 0;
    std::fill(sums_.begin(), sums_.end(), 0.0);
    fill(std::min(h, half_ + 1));
    for (int row = -half_; row <= half_; ++row) add_row(mean_row(row), sums_.data(), picture_.width);
    const double weight = 1.0 / (2 * half_ + 1);
    for (int row = 0; row < h; ++row) {
      fill(std::min(h, row + half_ + 2));
      next_row(mean_row(row + half_ + 1), mean_row(row - half_), weight, sums_.data(), pixels(row),
               picture_.width);
    }
  }

  std::size_t width() const { return std::size_t(picture_.width); }
  float* pixels(int row) { return &picture_.px[std::size_t(row) * width()]; }
  float* mean_row(int row) { return &means_[std::size_t(mirrored(row, picture_.height) % kept_) * width()]; }

  void copy_rows(int end) {
    for (; done_ < end; ++done_) std::copy_n(pixels(done_), picture_.width, mean_row(done_));
  }

  void mean_rows(int end, int times) {
    const int w = picture_.width;
    for (; done_ < end; done_ += kRows) {
      // Below the last row its pixels are used, and the results are dropped.
      Rows from{}, to{};
      for (int i = 0; i < kRows; ++i) {
        const int row = done_ + i, last = picture_.height - 1;
        from[std::size_t(i)] = pixels(std::min(row, last));
        to[std::size_t(i)] = row <= last ? mean_row(row) : dropped_.data();
      }
      rows_to_columns(from, w, column(half_));
      for (int i = 0; i < times; ++i) {
        mirror_columns();
        running_means(columns_.data(), w, half_);
        if (i + 1 < times) std::memmove(column(half_), column(0), std::size_t(w) * kRows * sizeof(float));
      }
      columns_to_rows(columns_.data(), w, to);
    }
  }

  void mirror_columns() {
    const int w = picture_.width;
    for (int i = 1; i <= half_; ++i)
      std::memcpy(column(half_ - i), column(half_ + mirrored(-i, w)), kRows * sizeof(float));
    for (int i = 0; i <= half_; ++i)
      std::memcpy(column(half_ + w + i), column(half_ + mirrored(w + i, w)), kRows * sizeof(float));
  }

  float* column(int i) { return &columns_[std::size_t(i) * kRows]; }

  GrayF& picture_;
  int half_, kept_, done_ = 0;  // rows with means along rows
  std::vector<float> means_, columns_, dropped_;
  std::vector<double> sums_;
};

}  // namespace

void box_filter(GrayF& picture, int half, int times) {
  if (times > 0) BoxFilter(picture, half).run(times);
}

}  // namespace faba
