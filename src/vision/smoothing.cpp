#include "vision/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/portable_math.h"

namespace faba {
namespace {

constexpr double kWidestSampled = 8;  // px; beyond it running means are faster and as good
constexpr int kMeans = 4;

// Mirrored about the last pixel, for any distance beyond the border.
int mirrored(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  i = std::abs(i) % period;
  return i < n ? i : period - i;
}

void convolve_rows(const GrayF& from, const std::vector<float>& weights, GrayF& to) {
  const int reach = int(weights.size()) - 1, w = from.width;
  std::vector<float> line(std::size_t(w + 2 * reach));
  for (int row = 0; row < from.height; ++row) {
    const float* in = &from.px[std::size_t(row) * std::size_t(w)];
    for (int i = -reach; i < w + reach; ++i)
      line[std::size_t(i + reach)] = in[i >= 0 && i < w ? i : mirrored(i, w)];
    float* out = &to.px[std::size_t(row) * std::size_t(w)];
    const float* middle = line.data() + reach;
    for (int i = 0; i < w; ++i) out[i] = weights[0] * middle[i];
    for (int k = 1; k <= reach; ++k) {
      const float weight = weights[std::size_t(k)];
      for (int i = 0; i < w; ++i) out[i] += weight * (middle[i - k] + middle[i + k]);
    }
  }
}

void convolve_columns(const GrayF& from, const std::vector<float>& weights, GrayF& to) {
  const int reach = int(weights.size()) - 1, w = from.width, h = from.height;
  const auto line = [&](int row) { return &from.px[std::size_t(mirrored(row, h)) * std::size_t(w)]; };
  for (int row = 0; row < h; ++row) {
    float* out = &to.px[std::size_t(row) * std::size_t(w)];
    const float* middle = line(row);
    for (int i = 0; i < w; ++i) out[i] = weights[0] * middle[i];
    for (int k = 1; k <= reach; ++k) {
      const float weight = weights[std::size_t(k)];
      const float *above = line(row - k), *below = line(row + k);
      for (int i = 0; i < w; ++i) out[i] += weight * (above[i] + below[i]);
    }
  }
}

// One running mean over 2 * half + 1 pixels along rows; `sum` in double, so that nothing builds up.
void mean_rows(GrayF& picture, int half) {
  const int w = picture.width;
  std::vector<float> line(static_cast<std::size_t>(w));
  const double share = 1.0 / (2 * half + 1);
  for (int row = 0; row < picture.height; ++row) {
    float* at = &picture.px[std::size_t(row) * std::size_t(w)];
    std::copy(at, at + w, line.begin());
    double sum = 0;
    for (int i = -half; i <= half; ++i) sum += double(line[std::size_t(mirrored(i, w))]);
    for (int i = 0; i < w; ++i) {
      at[i] = float(sum * share);
      sum += double(line[std::size_t(mirrored(i + half + 1, w))]) -
             double(line[std::size_t(mirrored(i - half, w))]);
    }
  }
}

void mean_columns(GrayF& picture, int half) {
  const int w = picture.width, h = picture.height;
  const GrayF from = picture;
  const auto line = [&](int row) { return &from.px[std::size_t(mirrored(row, h)) * std::size_t(w)]; };
  std::vector<double> sum(std::size_t(w), 0.0);
  const double share = 1.0 / (2 * half + 1);
  for (int row = -half; row <= half; ++row)
    for (int i = 0; i < w; ++i) sum[std::size_t(i)] += double(line(row)[i]);
  for (int row = 0; row < h; ++row) {
    float* out = &picture.px[std::size_t(row) * std::size_t(w)];
    const float *come = line(row + half + 1), *go = line(row - half);
    for (int i = 0; i < w; ++i) {
      out[i] = float(sum[std::size_t(i)] * share);
      sum[std::size_t(i)] += double(come[i]) - double(go[i]);
    }
  }
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
  if (picture.empty()) return picture;
  if (sd_px <= kWidestSampled) {
    const std::vector<float> weights = gaussian_weights(sd_px);
    GrayF rows(picture.width, picture.height), out(picture.width, picture.height);
    convolve_rows(picture, weights, rows);
    convolve_columns(rows, weights, out);
    return out;
  }
  // The variance of a mean over 2 h + 1 pixels is h (h + 1) / 3.
  const double wanted = 3 * sd_px * sd_px / kMeans;
  const int half = std::max(1, int(std::floor(std::sqrt(wanted + 0.25))));
  GrayF out = picture;
  for (int i = 0; i < kMeans; ++i) mean_rows(out, half), mean_columns(out, half);
  return out;
}

}  // namespace faba
