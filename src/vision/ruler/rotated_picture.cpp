#include "vision/ruler/rotated_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace faba {
namespace {

std::array<float, 4> cubic_weights(double fraction) {
  const float f = float(fraction), g = 1 - f;
  return {-0.5F * f * g * g, 1 + f * f * (1.5F * f - 2.5F), 1 + g * g * (1.5F * g - 2.5F), -0.5F * g * f * f};
}

float sample(const GrayF& picture, Vec2 p) {
  const int w = picture.width, h = picture.height;
  if (!(p.x >= 0 && p.y >= 0 && p.x <= w - 1 && p.y <= h - 1)) return std::numeric_limits<float>::quiet_NaN();
  const int col = std::min(int(p.x), w - 2), row = std::min(int(p.y), h - 2);
  const auto wx = cubic_weights(p.x - col), wy = cubic_weights(p.y - row);
  float sum = 0;
  for (int j = 0; j < 4; ++j) {
    const int r = std::clamp(row + j - 1, 0, h - 1);
    float line = 0;
    for (int i = 0; i < 4; ++i) line += wx[std::size_t(i)] * picture.at(std::clamp(col + i - 1, 0, w - 1), r);
    sum += wy[std::size_t(j)] * line;
  }
  return sum;
}

}  // namespace

RotatedPicture::RotatedPicture(const GrayF& picture, double angle)
    : cos_(std::cos(angle)),
      sin_(std::sin(angle)),
      centre_image_{(picture.width - 1) / 2.0, (picture.height - 1) / 2.0} {
  const double w = picture.width - 1, h = picture.height - 1;
  px_ = GrayF(int(std::ceil(std::fabs(w * cos_) + std::fabs(h * sin_) - 1e-9)) + 1,
              int(std::ceil(std::fabs(w * sin_) + std::fabs(h * cos_) - 1e-9)) + 1);
  for (int r = 0; r < px_.height; ++r)
    for (int c = 0; c < px_.width; ++c) px_.at(c, r) = sample(picture, image(first_s() + c, first_t() + r));
}

Vec2 RotatedPicture::image(double s, double t) const {
  return {centre_image_.x + s * cos_ - t * sin_, centre_image_.y + s * sin_ + t * cos_};
}

Vec2 RotatedPicture::rotated(Vec2 image) const {
  const Vec2 d = image - centre_image_;
  return {d.x * cos_ + d.y * sin_, d.y * cos_ - d.x * sin_};
}

std::vector<double> RotatedPicture::profile(double t, int height) const {
  const int top = int(std::lround(t - first_t() - (height - 1) / 2.0));
  if (height < 1 || top < 0 || top + height > px_.height) return {};
  std::vector<double> mean(std::size_t(px_.width), 0.0);
  for (int r = top; r < top + height; ++r)
    for (int c = 0; c < px_.width; ++c) mean[std::size_t(c)] += double(px_.at(c, r));  // NaN stays
  for (double& v : mean) v /= height;
  return mean;
}

}  // namespace faba
