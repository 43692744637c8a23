#include "vision/cells/kernels/spot_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/statistics.h"
#include "core/vectorised.h"

namespace faba {
namespace {

constexpr double kReach = 3.5;      // sd; beyond it the light of a spot is below 0.3 % of its maximum
constexpr double kRing = kReach;    // sd, inner radius of the ring for the local offset
constexpr double kRingWidth = 1.5;  // sd
constexpr double kWindow = 3;       // sd, radius of the Gaussian window
constexpr int kRowsAtOnce = 4;      // their recursions are independent, so that none waits for another

// exp(-(i - x)^2 / (2 sd^2)) for `first` <= i <= `last`, by recursion: the ratio of neighbouring values
// changes by a constant factor. Starts at the maximum, so that rounding errors are relative to it.
class Gaussian {
 public:
  explicit Gaussian(double sd) : a_(1 / (sd * sd)), half_(std::exp(-0.5 * a_)), curvature_(half_ * half_) {}
  void write(double x, int first, int last, double* out) const {
    const int middle = std::clamp(int(std::round(x)), first, last);
    const double d = middle - x, maximum = std::exp(-0.5 * a_ * d * d), slope = std::exp(a_ * d);
    double value = maximum, ratio = half_ / slope;
    for (int i = middle; i <= last; ++i, value *= ratio, ratio *= curvature_) out[i - first] = value;
    value = maximum;
    ratio = half_ * slope;
    for (int i = middle; i >= first; --i, value *= ratio, ratio *= curvature_) out[i - first] = value;
  }

 private:
  double a_, half_, curvature_;
};

// Weights of the rows: w, w dy, w dy^2.
using RowWeights = std::array<double, 3>;

// Sums over the rows of each column: `sums` has 3 x columns values, for the three weights.
FABA_VECTORISED void column_sums(const double* px, std::size_t stride, int rows, int columns, double offset,
                                 const RowWeights* weights, double* sums) {
  double *const a = sums, *const b = sums + columns, *const c = sums + 2 * std::size_t(columns);
  for (int r = 0; r < rows; ++r, px += stride) {
    const auto [w, wy, wyy] = weights[r];
    FABA_ELEMENTWISE
    for (int i = 0; i < columns; ++i) {
      const double v = px[i] - offset;
      a[i] += w * v;
      b[i] += wy * v;
      c[i] += wyy * v;
    }
  }
}

}  // namespace

SpotWindow::SpotWindow(double sd) : sd_(sd) {}

double SpotWindow::max_shift() const { return std::max(1.5, 1.5 * sd_); }

void SpotWindow::place(const GrayF& picture, int col, int row) {
  const double ring = kRing * sd_ + std::max(kRingWidth * sd_, 1.5);
  const int half = int(std::ceil(std::max(ring, kWindow * sd_ + 0.5 + max_shift()))) + 1;
  col_ = col;
  row_ = row;
  left_ = std::max(0, col - half);
  top_ = std::max(0, row - half);
  right_ = std::min(picture.width - 1, col + half);
  bottom_ = std::min(picture.height - 1, row + half);
  const std::size_t columns = width();
  px_.resize(columns * (std::size_t(bottom_) - std::size_t(top_) + 1));
  for (int r = top_; r <= bottom_; ++r) {
    const float* from = &picture.px[std::size_t(r) * std::size_t(picture.width) + std::size_t(left_)];
    std::copy(from, from + columns, this->row(r));
  }
}

void SpotWindow::subtract(const GaussianSpot& other) {
  const double ring = kRing * sd_ + std::max(kRingWidth * sd_, 1.5);
  const double reach =
      kReach * std::sqrt(std::max(other.cov.xx, other.cov.yy)) + std::ceil(ring + 1.5 * sd_) + 1;
  if (std::fabs(other.x - col_) > reach || std::fabs(other.y - row_) > reach) return;
  const double det = other.cov.xx * other.cov.yy - other.cov.xy * other.cov.xy;
  const double xx = other.cov.yy / det, xy = -other.cov.xy / det, yy = other.cov.xx / det,
               half = std::exp(-0.5 * xx), curvature = half * half;
  const std::size_t columns = width();
  for (int first = top_; first <= bottom_; first += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, bottom_ - first + 1);
    // The recursion along the rows starts near their maxima.
    const double peak = other.x - xy / xx * (first + 0.5 * (rows - 1) - other.y);
    const int from = int(std::clamp(std::round(peak), double(left_), double(right_)));
    const double dx = from - other.x;
    std::array<double, kRowsAtOnce> value{}, right{}, left{};
    for (int k = 0; k < rows; ++k) {
      const double dy = first + k - other.y, slope = xx * dx + xy * dy;
      const auto i = std::size_t(k);
      value[i] = other.amplitude * std::exp(-0.5 * (xx * dx * dx + 2 * xy * dx * dy + yy * dy * dy));
      const double ratio = std::exp(slope);
      right[i] = half / ratio;
      left[i] = half * ratio;
    }
    const auto sweep = [&](std::array<double, kRowsAtOnce> v, std::array<double, kRowsAtOnce> step, int col,
                           int end, int direction) {
      for (double* px = row(first) + (col - left_); col != end; col += direction, px += direction)
        for (std::size_t k = 0; k < kRowsAtOnce; ++k) {
          if (k < std::size_t(rows)) px[k * columns] -= v[k];
          v[k] *= step[k];
          step[k] *= curvature;
        }
    };
    sweep(value, right, from, right_ + 1, 1);
    for (std::size_t k = 0; k < kRowsAtOnce; ++k) {
      value[k] *= left[k];
      left[k] *= curvature;
    }
    sweep(value, left, from - 1, left_ - 1, -1);
  }
}

double SpotWindow::offset(double x, double y) {
  const double in = kRing * sd_, out = in + std::max(kRingWidth * sd_, 1.5);
  ring_.clear();
  for (int r = top_; r <= bottom_; ++r) {
    const double dy2 = (r - y) * (r - y);
    if (dy2 > out * out) continue;
    const double half = std::sqrt(out * out - dy2) + 1;  // one more: the test below decides
    const int first = std::max(left_, int(std::floor(x - half))),
              last = std::min(right_, int(std::ceil(x + half)));
    const double* px = row(r) - left_;
    for (int c = first; c <= last; ++c) {
      const double r2 = (c - x) * (c - x) + dy2;
      if (r2 >= in * in && r2 <= out * out) ring_.push_back(px[c]);
    }
  }
  return ring_.empty() ? 0 : median_high(ring_);
}

SpotMoments SpotWindow::moments(double x, double y, double offset) {
  SpotMoments m;
  const double reach = kWindow * sd_ + 0.5;
  const int left = std::max(left_, int(x - reach)), right = std::min(right_, int(x + reach + 1));
  const int top = std::max(top_, int(y - reach)), bottom = std::min(bottom_, int(y + reach + 1));
  if (left > right || top > bottom) return m;
  const std::size_t columns = std::size_t(right) - std::size_t(left) + 1,
                    rows = std::size_t(bottom) - std::size_t(top) + 1;
  across_.resize(columns + rows);
  const Gaussian gaussian(sd_);
  gaussian.write(x, left, right, across_.data());
  gaussian.write(y, top, bottom, &across_[columns]);
  weights_.resize(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const double w = across_[columns + r], dy = top + double(r) - y;
    weights_[r] = {w, w * dy, w * dy * dy};
  }
  sums_.assign(3 * columns, 0);
  column_sums(row(top) + (left - left_), width(), int(rows), int(columns), offset, weights_.data(),
              sums_.data());
  for (std::size_t c = 0; c < columns; ++c) {
    const double w = across_[c], dx = left + double(c) - x;
    m.mass += w * sums_[c];
    m.x += w * dx * sums_[c];
    m.cov.xx += w * dx * dx * sums_[c];
    m.y += w * sums_[columns + c];
    m.cov.xy += w * dx * sums_[columns + c];
    m.cov.yy += w * sums_[2 * columns + c];
  }
  if (m.mass <= 0) return m;
  m.x /= m.mass;
  m.y /= m.mass;
  m.cov = {m.cov.xx / m.mass - m.x * m.x, m.cov.xy / m.mass - m.x * m.y, m.cov.yy / m.mass - m.y * m.y};
  return m;
}

}  // namespace faba
