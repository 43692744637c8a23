#include "vision/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/portable_math.h"
#include "core/vectorised.h"

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

// out = w0 middle, or out += w (left + right), element by element.
FABA_VECTORISED void begin_sum(float* out, const float* middle, float weight, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] = weight * middle[i];
}
FABA_VECTORISED void add_pair(float* out, const float* left, const float* right, float weight, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] += weight * (left[i] + right[i]);
}

void convolve_rows(const GrayF& from, const std::vector<float>& weights, GrayF& to) {
  const int reach = int(weights.size()) - 1, w = from.width;
  std::vector<float> line(std::size_t(w + 2 * reach));
  for (int row = 0; row < from.height; ++row) {
    const float* in = &from.px[std::size_t(row) * std::size_t(w)];
    std::copy(in, in + w, line.begin() + reach);
    for (int i = 1; i <= reach; ++i) {
      line[std::size_t(reach - i)] = in[mirrored(-i, w)];
      line[std::size_t(reach + w) + std::size_t(i - 1)] = in[mirrored(w - 1 + i, w)];
    }
    float* out = &to.px[std::size_t(row) * std::size_t(w)];
    const float* middle = line.data() + reach;
    begin_sum(out, middle, weights[0], w);
    for (int k = 1; k <= reach; ++k) add_pair(out, middle - k, middle + k, weights[std::size_t(k)], w);
  }
}

void convolve_columns(const GrayF& from, const std::vector<float>& weights, GrayF& to) {
  const int reach = int(weights.size()) - 1, w = from.width, h = from.height;
  const auto line = [&](int row) { return &from.px[std::size_t(mirrored(row, h)) * std::size_t(w)]; };
  for (int row = 0; row < h; ++row) {
    float* out = &to.px[std::size_t(row) * std::size_t(w)];
    begin_sum(out, line(row), weights[0], w);
    for (int k = 1; k <= reach; ++k) add_pair(out, line(row - k), line(row + k), weights[std::size_t(k)], w);
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
  GrayF out, work;
  smooth(picture, sd_px, out, work);
  return out;
}

void smooth(const GrayF& picture, double sd_px, GrayF& out, GrayF& work) {
  for (GrayF* g : {&out, &work}) {
    g->width = picture.width, g->height = picture.height;
    g->px.resize(picture.px.size());
  }
  if (picture.empty()) return;
  if (sd_px <= kWidestSampled) {
    const std::vector<float> weights = gaussian_weights(sd_px);
    convolve_rows(picture, weights, work);
    convolve_columns(work, weights, out);
    return;
  }
  // The variance of a mean over 2 h + 1 pixels is h (h + 1) / 3.
  const double wanted = 3 * sd_px * sd_px / kMeans;
  const int half = std::max(1, int(std::floor(std::sqrt(wanted + 0.25))));
  out.px = picture.px;
  for (int i = 0; i < kMeans; ++i) mean_rows(out, half), mean_columns(out, half);
}

}  // namespace faba
