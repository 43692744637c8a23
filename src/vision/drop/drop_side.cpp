#include "vision/drop/drop_side.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/statistics.h"

namespace faba {
namespace {

constexpr double kSpotSd =
    7;                      // noise sd, minimum height of a spot: no false detections in 1e6 pixels of noise
constexpr int kBorder = 8;  // px, affected by the replicated border in the filters

double spread(std::vector<float>& v) { return v.empty() ? 0 : kMadToSd * double(median_high(v)); }

/// Side of the circle for a picture position: 1 inside, 0 outside, -1 within the margin.
class Sides {
 public:
  Sides(const Circle& c, double margin) : centre_(c.centre) {
    const double inner = std::max(c.radius - margin, 0.0), outer = c.radius + margin;
    inner2_ = inner * inner;
    outer2_ = outer * outer;
  }
  int operator()(int r, int c) const {
    const Vec2 d = Vec2{double(c), double(r)} - centre_;
    const double r2 = dot(d, d);
    return r2 < inner2_ ? 1 : r2 > outer2_ ? 0 : -1;
  }

 private:
  Vec2 centre_;
  double inner2_ = 0, outer2_ = 0;
};

bool is_peak(const cv::Mat1f& m, int r, int c) {
  const float height = m(r, c);
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      if ((i || j) &&
          (m(r + i, c + j) > height || (m(r + i, c + j) == height && (i < 0 || (i == 0 && j < 0)))))
        return false;
  return true;
}

/// log10 P(at most k of n) for success probability p, approximated by the largest term; sufficient for a
/// limit of 1e-6.
double log10_at_most(double k, double n, double p) {
  if (k >= n * p) return 0;
  return (std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
          (n - k) * std::log1p(-p)) /
         std::log(10.0);
}

}  // namespace

bool cells_only_outside(const GrayF& picture, const Circle& circle, double margin_px) {
  const cv::Mat1f view(picture.height, picture.width, const_cast<float*>(picture.px.data()));
  cv::Mat1f fine, broad;
  cv::GaussianBlur(view, fine, {7, 7}, 1.2, 1.2, cv::BORDER_REPLICATE);
  cv::blur(fine, broad, {13, 13}, {-1, -1}, cv::BORDER_REPLICATE);
  cv::Mat1f spots;
  cv::absdiff(fine, broad, spots);
  // The noise level depends on the light, so each side has its own scale.
  const Sides side(circle, margin_px);
  std::vector<float> values[2];
  for (int r = kBorder; r < picture.height - kBorder; r += 2)
    for (int c = kBorder; c < picture.width - kBorder; c += 2)
      if (const int s = side(r, c); s >= 0) values[s].push_back(spots(r, c));
  const double area[2] = {double(values[0].size()), double(values[1].size())};
  if (area[0] == 0 || area[1] == 0) return false;
  const float limit[2] = {float(kSpotSd * spread(values[0])), float(kSpotSd * spread(values[1]))};
  double count[2] = {0, 0};
  for (int r = kBorder; r < picture.height - kBorder; ++r)
    for (int c = kBorder; c < picture.width - kBorder; ++c)
      if (const float height = spots(r, c); height > std::min(limit[0], limit[1]))
        if (const int s = side(r, c); s >= 0 && height > limit[s] && is_peak(spots, r, c)) count[s] += 1;
  return count[0] >= 10 && count[0] / area[0] > 4 * count[1] / area[1] &&
         log10_at_most(count[1], count[0] + count[1], area[1] / (area[0] + area[1])) < -6;
}

Vec2 point_on_side(int width, int height, const Circle& circle, bool inside) {
  Vec2 sum, deepest;
  double count = 0, max_depth = -1e300;
  const int pitch = 1 + std::min(width, height) / 200;
  for (int r = 0; r < height; r += pitch)
    for (int c = 0; c < width; c += pitch) {
      const Vec2 p{double(c), double(r)};
      const double depth = (circle.radius - norm(p - circle.centre)) * (inside ? 1 : -1);
      if (depth > max_depth) {
        max_depth = depth;
        deepest = p;
      }
      if (depth > 0) {
        sum = sum + p;
        count += 1;
      }
    }
  // Disk and picture are convex, so the centroid of their intersection lies in both.
  return inside && count > 0 ? (1 / count) * sum : deepest;
}

}  // namespace faba
