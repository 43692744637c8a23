#include "vision/draw/field_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/statistics.h"
#include "vision/draw/fixed_point.h"
#include "vision/draw/scale_bar.h"

namespace faba {
namespace {

constexpr int kScaleWidth = 108;   // px, width of the colour bar at the right
constexpr int kArrowSpacing = 40;  // px between arrows
const cv::Scalar kInk{40, 40, 40}, kLight{250, 250, 250};

// Light line on a darker one, visible on any colour.
void line(cv::Mat& m, Vec2 a, Vec2 b, int thickness = 1) {
  cv::line(m, fixed_point(a), fixed_point(b), kInk, thickness + 2, cv::LINE_AA, kShift);
  cv::line(m, fixed_point(a), fixed_point(b), kLight, thickness, cv::LINE_AA, kShift);
}

void text(cv::Mat& m, const std::string& s, Vec2 at, bool on_paper = false) {
  const cv::Point p(int(at.x), int(at.y));
  if (!on_paper) cv::putText(m, s, p, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 3, cv::LINE_AA);
  cv::putText(m, s, p, cv::FONT_HERSHEY_SIMPLEX, 0.45, on_paper ? kInk : kLight, 1, cv::LINE_AA);
}

/// Range of magnitudes of the colour bar, as powers of ten.
struct Decades {
  double low, high;
  int level(double tesla) const {
    return std::clamp(int(std::lround(255 * (std::log10(std::max(tesla, 1e-30)) - low) / (high - low))), 0,
                      255);
  }
};

// The 99 % percentile (excludes the vicinity of the coils) and at most three decades below; field zeros have
// no lower limit.
Decades decades_of(const std::vector<Vec2>& b) {
  std::vector<double> size;
  for (std::size_t i = 0; i < b.size(); i += 7)
    if (std::isfinite(b[i].x + b[i].y)) size.push_back(norm(b[i]));
  if (size.empty()) return {-6, -3};
  const double high = std::max(quantile_low(size, 0.99), 1e-12);
  const double low = std::max(*std::min_element(size.begin(), size.end()), high / 1000);
  return {std::log10(low), std::max(std::log10(high), std::log10(low) + 0.1)};
}

std::string in_tesla(double tesla) {
  return tesla >= 1e-3   ? fmt::format("{:.3g} mT", tesla * 1e3)
         : tesla >= 1e-6 ? fmt::format("{:.3g} uT", tesla * 1e6)
                         : fmt::format("{:.3g} nT", tesla * 1e9);
}

cv::Mat palette() {
  cv::Mat levels(256, 1, CV_8UC1), colours;
  for (int i = 0; i < 256; ++i) levels.at<std::uint8_t>(i) = std::uint8_t(i);
  cv::applyColorMap(levels, colours, cv::COLORMAP_CIVIDIS);
  return colours;
}

void arrows(cv::Mat& m, const FieldScene& s) {
  for (int y = kArrowSpacing / 2; y < s.height; y += kArrowSpacing)
    for (int x = kArrowSpacing / 2; x < s.width; x += kArrowSpacing) {
      if (x < 0.3 * s.width && y > s.height - 50) continue;  // region of the scale bar
      const Vec2 b = s.b[std::size_t(y) * std::size_t(s.width) + std::size_t(x)];
      const double size = norm(b);
      if (!(size > 0) || !std::isfinite(size)) continue;
      const Vec2 d{b.x / size, -b.y / size}, across{-d.y, d.x}, middle{double(x), double(y)};
      const Vec2 tip = middle + 11 * d;
      line(m, middle - 11 * d, tip);
      line(m, tip, tip - 5 * d + 3 * across);
      line(m, tip, tip - 5 * d - 3 * across);
    }
}

void colour_scale(cv::Mat& m, const FieldScene& s, const Decades& decades, const cv::Mat& colours) {
  const int left = s.width + 12, top = 20, bottom = s.height - 20;
  for (int y = top; y < bottom; ++y) {
    const int level = 255 - 255 * (y - top) / (bottom - 1 - top);
    cv::line(m, {left, y}, {left + 16, y}, cv::Scalar(colours.at<cv::Vec3b>(level)), 1);
  }
  for (int i = 0; i <= 4; ++i) {
    const double y = bottom - i * (bottom - top) / 4.0;
    text(m, in_tesla(std::pow(10.0, decades.low + i * (decades.high - decades.low) / 4)),
         {left + 20.0, y + 4}, true);
  }
}

void scale_bar(cv::Mat& m, const FieldScene& s) {
  const ScaleBar bar = scale_bar_for(s.width, s.um_per_px);
  const Vec2 from{14, s.height - 16.0};
  line(m, from, from + Vec2{bar.length_px, 0}, 3);
  text(m, bar.label, from - Vec2{0, 8});
}

}  // namespace

RgbImage draw_field(const FieldScene& s) {
  RgbImage out(s.width + kScaleWidth, s.height, Rgb{255, 255, 255});
  cv::Mat canvas(out.height, out.width, CV_8UC3, out.px.data());
  cv::Mat m = canvas(cv::Rect(0, 0, s.width, s.height));
  const Decades decades = decades_of(s.b);
  cv::Mat colours = palette();
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGB);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x)
      m.at<cv::Vec3b>(y, x) = colours.at<cv::Vec3b>(
          decades.level(norm(s.b[std::size_t(y) * std::size_t(s.width) + std::size_t(x)])));
  arrows(m, s);
  for (const auto& stroke : s.coils)
    for (std::size_t i = 1; i < stroke.size(); ++i) line(m, stroke[i - 1], stroke[i]);
  const Vec2 middle{(s.width - 1) / 2.0, (s.height - 1) / 2.0};
  if (s.drop_radius_px > 0) {
    for (const int thickness : {3, 1})
      cv::circle(m, fixed_point(middle), fixed_length(s.drop_radius_px), thickness == 3 ? kInk : kLight,
                 thickness, cv::LINE_AA, kShift);
  }
  if (s.view_px) {
    const Vec2 h = 0.5 * *s.view_px, corner[] = {{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}};
    for (int i = 0; i < 4; ++i) line(m, middle + corner[i], middle + corner[(i + 1) % 4]);
  }
  for (const auto& z : s.zeros) {
    line(m, z.at + Vec2{-8, -8}, z.at + Vec2{8, 8}, 2);
    line(m, z.at + Vec2{-8, 8}, z.at + Vec2{8, -8}, 2);
    text(m, z.words, z.at + Vec2{12, -8});
  }
  scale_bar(m, s);
  colour_scale(canvas, s, decades, colours);
  return out;
}

}  // namespace faba
