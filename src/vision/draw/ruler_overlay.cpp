#include "vision/draw/ruler_overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "vision/draw/fixed_point.h"

namespace faba {
namespace {

// Okabe and Ito's colour-blind-safe palette.
const cv::Scalar kRulerSky(86, 180, 233), kRulerYellow(240, 228, 66), kRulerOrange(255, 120, 0),
    kRulerRim(0, 0, 0);

void label(cv::Mat3b& canvas, Vec2 at, const std::string& text, double size) {
  int below = 0;
  const cv::Size box = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &below);
  const cv::Point corner(int(std::lround(at.x)) - box.width / 2, int(std::lround(at.y)) + box.height / 2);
  const int width = std::max(1, int(size * 2));
  cv::putText(canvas, text, corner, cv::FONT_HERSHEY_SIMPLEX, size, kRulerRim, width + 2, cv::LINE_AA);
  cv::putText(canvas, text, corner, cv::FONT_HERSHEY_SIMPLEX, size, kRulerYellow, width, cv::LINE_AA);
}

}  // namespace

RgbImage ruler_overlay(const RgbImage& picture, const Ruler& ruler) {
  cv::Mat3b canvas(picture.height, picture.width);
  std::transform(picture.px.begin(), picture.px.end(), canvas.begin(),
                 [](const Rgb& v) { return cv::Vec3b(v.r, v.g, v.b); });
  const MarkRow& row = ruler.row;
  const int width = std::clamp(int(row.pitch_px / 8), 1, 3);
  const double size = std::clamp(std::min(picture.width, picture.height) / 1100.0, 0.4, 1.2);
  const Vec2 across{-std::sin(row.angle), std::cos(row.angle)};
  const int every = std::max(1, int(std::ceil(28 * size * 2 / (10 * row.pitch_px)))) * 10;
  for (const RowMark& m : row.marks) {
    const int number = m.index - row.marks.front().index;
    const Vec2 middle = 0.5 * (m.from_image + m.to_image);
    const bool tenth = number % 10 == 0;
    // Every tenth line extends beyond the marks and is labelled with its number.
    const Vec2 end = tenth ? m.to_image + (10 * size * 2) * across : m.to_image;
    cv::line(canvas, fixed_point(middle), fixed_point(end),
             !m.used ? kRulerOrange
             : tenth ? kRulerYellow
                     : kRulerSky,
             width, cv::LINE_AA, kShift);
    if (number % every == 0) label(canvas, end + (14 * size * 2) * across, std::to_string(number), size);
  }
  RgbImage out(picture.width, picture.height);
  std::transform(canvas.begin(), canvas.end(), out.px.begin(), [](const cv::Vec3b& v) {
    return Rgb{v[0], v[1], v[2]};
  });
  return out;
}

}  // namespace faba
