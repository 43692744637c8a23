#include "vision/image/kernels/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/portable_math.h"
#include "core/wide.h"
#include "vision/image/kernels/box_filter.h"
#include "vision/image/kernels/grey_scale.h"
#include "vision/image/kernels/mirrored.h"

namespace faba {
namespace {

constexpr double kWidestSampled = 8;  // px; above, box filters are faster at the same accuracy
constexpr int kMeans = 4;

// out[i] = w0 middle[i] + w1 (before1[i] + after1[i]) + ..., added in this order.
struct Taps {
  const std::vector<float>& weights;
  const float* const* before;  ///< [k]: row of weight k; [0] is the centre
  const float* const* after;
};

template <int bytes>
[[gnu::always_inline]] inline void add_taps_in(const Taps& t, float* out, int n) {
  using V = typename Wide<float, bytes>::type;
  constexpr std::ptrdiff_t kLanes = bytes / int(sizeof(float)),
                           kAtOnce = 4;  // independent sums, for instruction-level parallelism
  const int taps = int(t.weights.size());
  const float* w = t.weights.data();
  std::ptrdiff_t i = 0;
  for (; i + kAtOnce * kLanes <= n; i += kAtOnce * kLanes) {
    V sum[kAtOnce];
#pragma GCC unroll 4
    for (std::ptrdiff_t a = 0; a < kAtOnce; ++a)
      sum[a] = w[0] * *reinterpret_cast<const V*>(t.before[0] + i + a * kLanes);
    for (int k = 1; k < taps; ++k)
#pragma GCC unroll 4
      for (std::ptrdiff_t a = 0; a < kAtOnce; ++a)
        sum[a] += w[k] * (*reinterpret_cast<const V*>(t.before[k] + i + a * kLanes) +
                          *reinterpret_cast<const V*>(t.after[k] + i + a * kLanes));
#pragma GCC unroll 4
    for (std::ptrdiff_t a = 0; a < kAtOnce; ++a) *reinterpret_cast<V*>(out + i + a * kLanes) = sum[a];
  }
  for (; i < n; ++i) {
    float sum = w[0] * t.before[0][i];
    for (int k = 1; k < taps; ++k) sum += w[k] * (t.before[k][i] + t.after[k][i]);
    out[i] = sum;
  }
}
FABA_WIDE(add_taps, (const Taps& t, float* out, int n), (t, out, n))

// Separable convolution. Rows are smoothed horizontally when first needed, and only the rows of one vertical
// kernel are kept, so they stay in the second-level cache.
void convolve(int w, int h, const RowSource& row_of, const std::vector<float>& weights, GrayF& out,
              GrayF& work) {
  const int reach = int(weights.size()) - 1;
  // An odd number of cache lines from row to row: at a multiple of 4 KiB, a column of rows would share a few
  // lines of the first-level cache.
  constexpr int kLine = 64 / int(sizeof(float));
  work.width = ((w + kLine - 1) / kLine | 1) * kLine;
  work.height = std::min(h, 2 * reach + 1);
  work.px.resize(std::size_t(work.width) * std::size_t(work.height));
  const auto kept = [&](int row) {
    return &work.px[std::size_t(row % work.height) * std::size_t(work.width)];
  };
  std::vector<float> line(std::size_t(w + 2 * reach));
  std::vector<const float*> left, right, above(weights.size()), below(weights.size());
  for (int k = 0; k <= reach; ++k) {
    left.push_back(line.data() + reach - k);
    right.push_back(line.data() + reach + k);
  }
  int next = 0;
  for (int row = 0; row < h; ++row) {
    for (; next < std::min(h, row + reach + 1); ++next) {
      const float* in = row_of(next);
      std::copy(in, in + w, line.begin() + reach);
      for (int i = 1; i <= reach; ++i) {
        line[std::size_t(reach - i)] = in[mirrored(-i, w)];
        line[std::size_t(reach + w) + std::size_t(i - 1)] = in[mirrored(w - 1 + i, w)];
      }
      add_taps({weights, left.data(), right.data()}, kept(next), w);
    }
    for (int k = 0; k <= reach; ++k) {
      above[std::size_t(k)] = kept(mirrored(row - k, h));
      below[std::size_t(k)] = kept(mirrored(row + k, h));
    }
    add_taps({weights, above.data(), below.data()}, &out.px[std::size_t(row) * std::size_t(w)], w);
  }
}

/// Where a pixel of a large picture lies between the pixels of a picture of averaged squares.
struct Between {
  std::size_t before = 0, after = 0;
  float weight = 0;  // of `after`
};

std::vector<Between> places(int size, int small_size, int side) {
  std::vector<Between> all;
  for (int i = 0; i < size; ++i) {
    const float at = std::clamp((float(i) + 0.5F) / float(side) - 0.5F, 0.0F, float(small_size - 1));
    const int before = std::min(int(at), std::max(0, small_size - 2));
    all.push_back(
        {std::size_t(before), std::size_t(std::min(before + 1, small_size - 1)), at - float(before)});
  }
  return all;
}

// Linear interpolation.
GrayF enlarged(const GrayF& small, int side, int width, int height) {
  GrayF out(width, height);
  const std::vector<Between> columns = places(width, small.width, side),
                             rows = places(height, small.height, side);
  const auto small_row = [&](std::size_t r) { return &small.px[r * std::size_t(small.width)]; };
  std::vector<float> line(std::size_t(small.width));
  float* to = out.px.data();
  for (const Between& row : rows) {
    const float *above = small_row(row.before), *below = small_row(row.after);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = above[i] + row.weight * (below[i] - above[i]);
    for (const Between& c : columns) *to++ = line[c.before] + c.weight * (line[c.after] - line[c.before]);
  }
  return out;
}

}  // namespace

std::vector<float> gaussian_weights(double sd_px) {
  const int reach = std::max(1, int(std::ceil(4 * sd_px)));
  std::vector<float> weights;
  double total = 0;
  for (int k = 0; k <= reach; ++k) {
    const double z = double(k) / sd_px;
    weights.push_back(portable::exp(float(-0.5 * z * z)));
    total += (k == 0 ? 1 : 2) * double(weights.back());
  }
  for (float& weight : weights) weight = float(double(weight) / total);
  return weights;
}

GrayF smoothed(const GrayF& picture, double sd_px) {
  GrayF out, work;
  const auto row = [&](int r) { return &picture.px[std::size_t(r) * std::size_t(picture.width)]; };
  smooth(picture.width, picture.height, row, sd_px, out, work);
  return out;
}

GrayF smoothed_broadly(const GrayF& picture, double sd_px) {
  constexpr double kLeastSd = 16;  // px of the picture of averaged squares
  const int side = std::min({int(sd_px / kLeastSd), picture.width, picture.height});
  if (side < 2) return smoothed(picture, sd_px);
  GrayF small;
  shrink(picture, side, small);
  return enlarged(smoothed(small, sd_px / side), side, picture.width, picture.height);
}

void smooth(int width, int height, const RowSource& row, double sd_px, GrayF& out, GrayF& work) {
  out.width = width;
  out.height = height;
  out.px.resize(std::size_t(width) * std::size_t(height));
  if (out.empty()) return;
  if (sd_px <= kWidestSampled) {
    convolve(width, height, row, gaussian_weights(sd_px), out, work);
    return;
  }
  // The variance of a box filter over 2 h + 1 pixels is h (h + 1) / 3.
  const double wanted = 3 * sd_px * sd_px / kMeans;
  const int half = std::max(1, int(std::floor(std::sqrt(wanted + 0.25))));
  for (int r = 0; r < height; ++r) {
    const float* in = row(r);
    std::copy(in, in + width, &out.px[std::size_t(r) * std::size_t(width)]);
  }
  box_filter(out, half, kMeans);
}

}  // namespace faba
