#include "vision/image/kernels/grey_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/statistics.h"
#include "core/vectorised.h"

namespace faba {

GreyScale::GreyScale(int bits, const GrayF& first_frame) {
  if (bits <= 8) return;
  std::vector<float> greys;
  for (const float g : first_frame.px)
    if (std::isfinite(g)) greys.push_back(g);
  if (greys.empty()) return;
  black_ = quantile_low(greys, 0.001);
  white_ = quantile_low(greys, 0.999);
  if (!(white_ > black_)) white_ = black_ + 255;  // uniform frame: no range to map
}

void GreyScale::apply(GrayF& frame) const {
  if (black_ == 0 && white_ == 255) return;
  const float scale = 255 / (white_ - black_);
  for (float& g : frame.px) g = std::isfinite(g) ? (g - black_) * scale : 0;
}

std::string GreyScale::words() const {
  if (black_ == 0 && white_ == 255) return "";
  return fmt::format(
      "grey values {:g} to {:g} (0.1 % and 99.9 % percentiles of the first frame) were scaled to 0 to 255",
      black_, white_);
}

namespace {

FABA_VECTORISED void round_greys(const float* grey, std::uint8_t* out, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) {
    const float up = grey[i] + 0.5F, least = up > 0.0F ? up : 0.0F;
    out[i] = std::uint8_t(int(least < 255.0F ? least : 255.0F));
  }
}

FABA_VECTORISED void add_row(const float* row, float* sum, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) sum[i] += row[i];
}

FABA_VECTORISED void add_neighbours(const float* sums, float weight, float* out, int n) {
  FABA_ELEMENTWISE
  for (std::ptrdiff_t i = 0; i < n; ++i) out[i] = (sums[2 * i] + sums[2 * i + 1]) * weight;
}

}  // namespace

Gray8 rounded(const GrayF& frame) {
  Gray8 out(frame.width, frame.height);
  round_greys(frame.px.data(), out.px.data(), int(frame.px.size()));
  return out;
}

void shrink(const GrayF& frame, int side, GrayF& out) {
  if (side == 1) {
    out = frame;
    return;
  }
  const int w = frame.width / side, h = frame.height / side;
  if (out.width != w || out.height != h) out = GrayF(w, h);
  const float weight = 1 / float(side * side);
  std::vector<float> column(std::size_t(w) * std::size_t(side));
  for (int r = 0; r < h; ++r) {
    std::fill(column.begin(), column.end(), 0.0F);
    for (int i = 0; i < side; ++i)
      add_row(&frame.px[std::size_t(r * side + i) * std::size_t(frame.width)], column.data(),
              int(column.size()));
    if (side == 2) {
      add_neighbours(column.data(), weight, &out.at(0, r), w);
      continue;
    }
    for (int c = 0; c < w; ++c) {
      float sum = 0;
      for (int i = 0; i < side; ++i) sum += column[std::size_t(c) * std::size_t(side) + std::size_t(i)];
      out.at(c, r) = sum * weight;
    }
  }
}

}  // namespace faba
