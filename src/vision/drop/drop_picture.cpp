#include "vision/drop/drop_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/statistics.h"
#include "vision/drop/drop_edge_options.h"

namespace faba {
namespace {

constexpr int kSmallestSide = 64;  // px: a smaller picture has too few arc pieces for a significant test
constexpr int kSmallestCopy = 48;  // px, coarsest pyramid level

cv::Mat1f view_of(GrayF& g) { return {g.height, g.width, g.px.data()}; }

/// About 30000 of the values, evenly subsampled over rows and columns, for fast percentiles.
std::vector<float> sample(const float* values, int width, int height) {
  const std::size_t size = std::size_t(width) * std::size_t(height);
  std::size_t stride = 1 + size / 30000;
  while (std::gcd(stride, std::size_t(width)) != 1) ++stride;
  std::vector<float> some;
  for (std::size_t i = 0; i < size; i += stride) some.push_back(values[i]);
  return some;
}

std::vector<float> sample(const GrayF& g) { return sample(g.px.data(), g.width, g.height); }

void replace_hot_pixels(GrayF& grey, double limit_sd) {
  cv::Mat1f view = view_of(grey), median, off;
  cv::medianBlur(view, median, 3);
  cv::absdiff(view, median, off);
  std::vector<float> some = sample(off.ptr<float>(), grey.width, grey.height);
  // A uniform picture has sd 0; any deviation from the median of the neighbours is then a defect.
  const double limit = std::max(limit_sd * kMadToSd * double(quantile_low(some, 0.5)), 1e-6);
  const float *distance = off.ptr<float>(), *median_px = median.ptr<float>();
  for (std::size_t i = 0; i < grey.px.size(); ++i)
    if (double(distance[i]) > limit) grey.px[i] = median_px[i];
}

/// Standard deviation of the pixel noise from differences of neighbours, without the largest tenth (edges).
double noise_sd(const GrayF& g) {
  std::vector<float> squares;
  const std::size_t stride = 1 + g.px.size() / 30000;
  for (std::size_t i = 0; i + 1 < g.px.size(); i += stride)
    squares.push_back((g.px[i + 1] - g.px[i]) * (g.px[i + 1] - g.px[i]));
  const auto cut = squares.begin() + std::ptrdiff_t(0.9 * double(squares.size()));
  std::nth_element(squares.begin(), cut, squares.end());
  const double mean = std::accumulate(squares.begin(), cut, 0.0) / double(cut - squares.begin());
  // A Gaussian truncated to 90 % has 0.623 of its variance; a difference has twice the variance of a pixel.
  return std::sqrt(mean / 0.623 / 2);
}

/// Height of quantisation contours, grey of the picture. Noise of sd s dithers steps q of the grey scale: the
/// first harmonic of the staircase decreases as exp(-2 pi^2 (s/q)^2).
double contour_height(std::vector<float> some, double noise) {
  std::sort(some.begin(), some.end());
  double step = 0;
  for (std::size_t i = 1; i < some.size(); ++i)
    if (const double d = double(some[i] - some[i - 1]); d > 0 && (step == 0 || d < step)) step = d;
  if (double(some.back() - some.front()) <= step) return 0;  // two grey values: a mask, its step is the edge
  const double ratio = step > 0 ? noise / step : 1;
  return step * std::min(1.0, 4 * std::exp(-2 * std::numbers::pi * std::numbers::pi * ratio * ratio));
}

GrayF halved(const GrayF& g) {
  GrayF half(g.width / 2, g.height / 2);
  for (int r = 0; r < half.height; ++r)
    for (int c = 0; c < half.width; ++c)
      half.at(c, r) = 0.25f * (g.at(2 * c, 2 * r) + g.at(2 * c + 1, 2 * r) + g.at(2 * c, 2 * r + 1) +
                               g.at(2 * c + 1, 2 * r + 1));
  return half;
}

GrayF without_shading(const GrayF& g, double square_px) {
  GrayF flat = g;
  if (square_px < 1) return flat;
  cv::Mat1f view = view_of(flat), mean;
  const int side = 2 * int(square_px / 2) + 1;
  cv::blur(view, mean, {side, side}, {-1, -1}, cv::BORDER_REFLECT_101);
  view -= mean;
  return flat;
}

void check(const GrayF& picture, const DropEdgeOptions& o) {
  if (std::min(picture.width, picture.height) < kSmallestSide)
    throw Error(
        Errc::input, o.name,
        fmt::format(
            "the picture is {} x {} px; it must be at least {} px in each direction for drop detection",
            picture.width, picture.height, kSmallestSide));
  if (!std::all_of(picture.px.begin(), picture.px.end(), [](float p) { return std::isfinite(p); }))
    throw Error(Errc::input, o.name,
                "the picture has pixels that are not finite; export it from the camera again");
}

}  // namespace

DropPicture prepare_drop_picture(const GrayF& picture, const DropEdgeOptions& o) {
  // Prevents OpenCV threads in addition to the thread pool.
  [[maybe_unused]] static const bool one_thread = [] {
    cv::setNumThreads(1);
    return true;
  }();
  check(picture, o);
  GrayF grey = picture;
  if (o.hot_pixel_sd > 0) replace_hot_pixels(grey, o.hot_pixel_sd);
  std::vector<float> some = sample(grey);
  const auto low = double(quantile_low(some, o.stretch_low));
  const auto high = double(quantile_low(some, o.stretch_high));
  if (!(high > low))
    throw Error(Errc::input, o.name,
                fmt::format("the picture is uniform (grey {:.6g}); check light, exposure and shutter", low));
  DropPicture out;
  out.gain = 255 / (high - low);
  out.contours = out.gain * contour_height(std::move(some), noise_sd(grey));
  for (float& p : grey.px) p = float(std::clamp((double(p) - low) * out.gain, 0.0, 255.0));
  double scale = 1;
  for (int k = 0; k <= o.halvings; ++k, scale *= 2) {
    if (k > 0) {
      if (std::min(grey.width, grey.height) < 2 * kSmallestCopy) break;
      grey = halved(grey);
    }
    out.levels.push_back({grey, without_shading(grey, o.flatten_px), scale});
  }
  return out;
}

}  // namespace faba
