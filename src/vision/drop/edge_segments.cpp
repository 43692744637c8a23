#include "vision/drop/edge_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/statistics.h"

namespace faba {
namespace {

/// Gradient by Roberts' cross; element (r, c) belongs to position (c + 1/2, r + 1/2).
struct Gradient {
  cv::Mat1f dx, dy, power;  // power = dx^2 + dy^2
};

cv::Mat1f smooth(const GrayF& picture, double sigma) {
  cv::Mat1f view(picture.height, picture.width, const_cast<float*>(picture.px.data()));
  if (sigma <= 0) return view;
  cv::Mat1f out;
  const int size = 2 * int(std::ceil(2 * sigma)) + 1;
  cv::GaussianBlur(view, out, {size, size}, sigma, sigma, cv::BORDER_REPLICATE);
  return out;
}

Gradient roberts(const cv::Mat1f& s) {
  Gradient g;
  const int rows = s.rows - 1, cols = s.cols - 1;
  g.dx.create(rows, cols);
  g.dy.create(rows, cols);
  g.power.create(rows, cols);
  for (int r = 0; r < rows; ++r) {
    const float *top = s[r], *low = s[r + 1];
    float *dx = g.dx[r], *dy = g.dy[r], *power = g.power[r];
    for (int c = 0; c < cols; ++c) {
      // g1 points up-left, g2 up-right, each over sqrt(2) px: half their difference and sum are d/dx and
      // -d/dy.
      const float g1 = top[c] - low[c + 1], g2 = top[c + 1] - low[c];
      dx[c] = 0.5f * (g2 - g1);
      dy[c] = -0.5f * (g1 + g2);
      power[c] = dx[c] * dx[c] + dy[c] * dy[c];
    }
  }
  return g;
}

/// Otsu threshold of the gradient magnitude, squared.
double otsu_power(const cv::Mat1f& power) {
  double top = 0;
  cv::minMaxLoc(power, nullptr, &top);
  if (!(top > 0)) return 0;
  cv::Mat1b bytes(power.size());
  const double scale = 255 / std::sqrt(top);
  std::transform(power.begin(), power.end(), bytes.begin(),
                 [&](float p) { return uchar(std::sqrt(double(p)) * scale); });
  const double level = (cv::threshold(bytes, bytes, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU) + 1) / scale;
  return level * level;
}

/// For pure noise the squared gradient is exponential: its mean is median / ln 2, and a threshold of 4 means
/// passes exp(-4) = 1.8 % of the pixels before thinning.
double noise_power(const cv::Mat1f& power) {
  std::vector<float> sample;
  const std::size_t stride = 1 + power.total() / 30000;
  for (std::size_t i = 0; i < power.total(); i += stride)
    sample.push_back(*(power.begin() + std::ptrdiff_t(i)));
  return 4 * double(median_high(sample)) / std::numbers::ln2;
}

double threshold_power(const cv::Mat1f& power, const EdgeSegmentOptions& o) {
  if (o.threshold == EdgeThreshold::fixed) return o.fixed_threshold * o.fixed_threshold;
  if (o.threshold == EdgeThreshold::otsu) return otsu_power(power);
  if (o.threshold == EdgeThreshold::noise) return noise_power(power);
  return 6 * cv::mean(power)[0];
}

/// Non-maximum suppression: pixels above the threshold and not weaker than both neighbours along the
/// gradient.
cv::Mat1b thin(const Gradient& g, double power_limit) {
  cv::Mat1b edges(g.power.size(), uchar(0));
  for (int r = 1; r + 1 < edges.rows; ++r)
    for (int c = 1; c + 1 < edges.cols; ++c) {
      const float p = g.power(r, c);
      if (!(double(p) > power_limit)) continue;
      const float ax = std::fabs(g.dx(r, c)), ay = std::fabs(g.dy(r, c));
      // 0.414 = tan(22.5 deg): selects the neighbour in the 45 deg sector of the gradient.
      const int along = g.dx(r, c) * g.dy(r, c) >= 0 ? 1 : -1;
      const int sc = ax > 0.414f * ay ? 1 : 0, sr = ay > 0.414f * ax ? (sc ? along : 1) : 0;
      if (p >= g.power(r + sr, c + sc) && p > g.power(r - sr, c - sc)) edges(r, c) = 255;
    }
  return edges;
}

void keep_strongest(cv::Mat1b& edges, const Gradient& g, std::size_t limit) {
  std::vector<float> powers;
  for (int r = 0; r < edges.rows; ++r)
    for (int c = 0; c < edges.cols; ++c)
      if (edges(r, c)) powers.push_back(g.power(r, c));
  if (powers.size() <= limit) return;
  const auto cut = powers.begin() + std::ptrdiff_t(powers.size() - limit);
  std::nth_element(powers.begin(), cut, powers.end());
  edges.setTo(0, g.power < double(*cut));
}

std::vector<EdgePixel> list_pixels(const cv::Mat1b& edges, const Gradient& g) {
  std::vector<EdgePixel> out;
  for (int r = 0; r < edges.rows; ++r)
    for (int c = 0; c < edges.cols; ++c) {
      if (!edges(r, c)) continue;
      const double m = std::sqrt(double(g.power(r, c)));
      out.push_back({{c + 0.5, r + 0.5}, {double(g.dx(r, c)) / m, double(g.dy(r, c)) / m}});
    }
  return out;
}

double length(const EdgeSegment& s) { return norm(s.b - s.a); }

std::vector<EdgeSegment> hough_segments(const cv::Mat1b& edges, const EdgeSegmentOptions& o) {
  std::vector<cv::Vec4i> lines;
  // Votes: half the minimum length, because gaps are bridged.
  const int votes = std::max(6, int(o.min_length_px / 2));
  cv::HoughLinesP(edges, lines, 1, std::numbers::pi / 180, votes, o.min_length_px, o.fill_gap_px);
  std::vector<EdgeSegment> segments;
  segments.reserve(lines.size());
  for (const cv::Vec4i& l : lines) segments.push_back({{l[0] + 0.5, l[1] + 0.5}, {l[2] + 0.5, l[3] + 0.5}});
  std::stable_sort(segments.begin(), segments.end(),
                   [](const auto& a, const auto& b) { return length(a) > length(b); });
  if (segments.size() > std::size_t(o.max_segments)) segments.resize(std::size_t(o.max_segments));
  return segments;
}

/// A segment prepared for the test of supporting pixels.
struct Strip {
  Vec2 start, along;
  double length = 0;
  explicit Strip(const EdgeSegment& s) : start(s.a), length(norm(s.b - s.a)) {
    along = (1 / length) * (s.b - s.a);
  }
  bool supports(const EdgePixel& p) const {
    constexpr double kOff = 1.5, kOver = 2,
                     kCos = 0.819;  // px, px, cos 35 deg: tolerances for arcs and pixel noise
    const Vec2 across{-along.y, along.x}, d = p.pos - start;
    const double t = dot(d, along);
    return std::fabs(dot(d, across)) <= kOff && t >= -kOver && t <= length + kOver &&
           std::fabs(dot(p.normal, across)) >= kCos;
  }
};

}  // namespace

EdgeSegments find_edge_segments(const GrayF& picture, const EdgeSegmentOptions& options) {
  EdgeSegments out;
  if (picture.width < 4 || picture.height < 4) return out;
  const Gradient g = roberts(smooth(picture, options.sigma_px));
  const double power = threshold_power(g.power, options);
  out.threshold = std::sqrt(power);
  cv::Mat1b edges = thin(g, power);
  keep_strongest(edges, g, options.max_edge_pixels);
  out.segments = hough_segments(edges, options);
  out.pixels = list_pixels(edges, g);
  const std::vector<Strip> strips(out.segments.begin(), out.segments.end());
  for (const EdgePixel& p : out.pixels)
    if (std::any_of(strips.begin(), strips.end(), [&](const Strip& s) { return s.supports(p); }))
      out.support.push_back(p);
  return out;
}

}  // namespace faba
