#include "vision/draw/flow_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/statistics.h"
#include "vision/draw/fixed_point.h"

namespace faba {
namespace {

const cv::Vec3b kUnknown(128, 128, 128);

// Hues from red over yellow, green, cyan, blue and magenta to red. The number of steps between two hues
// follows the colour discrimination of the eye (Baker et al. 2011).
struct Wheel {
  std::array<cv::Vec3d, 56> hue;
  Wheel() {
    const cv::Vec3d corner[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
    const int steps[] = {15, 6, 4, 11, 13, 6};
    std::size_t n = 0;
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < steps[k]; ++i)
        hue[n++] = corner[k] + (corner[k + 1] - corner[k]) * (double(i) / steps[k]);
    hue[n] = hue[0];
  }
  /// Colour of a flow; 1 is full saturation, larger values are darker.
  cv::Vec3b colour(double u, double v) const {
    if (!std::isfinite(u) || !std::isfinite(v)) return kUnknown;
    const double strength = std::hypot(u, v);
    const double turn = (std::atan2(-v, -u) / std::numbers::pi + 1) / 2 * 55;  // red: to the right
    const auto below = std::size_t(std::clamp(turn, 0.0, 54.999));
    const cv::Vec3d pure = hue[below] + (hue[below + 1] - hue[below]) * (turn - double(below));
    cv::Vec3b out;
    for (int c = 0; c < 3; ++c)
      out[c] = cv::saturate_cast<std::uint8_t>(
          255 * (strength <= 1 ? 1 - strength * (1 - pure[c]) : 0.75 * pure[c]));
    return out;
  }
};
const Wheel& wheel() {
  static const Wheel one;
  return one;
}

cv::Mat3b canvas_of(RgbImage& picture) {
  static_assert(sizeof(Rgb) == 3);
  return {picture.height, picture.width, reinterpret_cast<cv::Vec3b*>(picture.px.data())};
}

constexpr double kMinArrowSpeed = 0.2;  // minimum speed of a flow with an arrow, fraction of the full speed

// Speed-weighted mean flow and position of each square, so that arrows are located at moving objects.
void draw_arrows(cv::Mat3b canvas, const Flow& flow, const FlowDrawing& how, double full, bool coloured) {
  const int step = how.arrow_step_px;
  for (int r = step / 2; r < flow.height(); r += step)
    for (int c = step / 2; c < flow.width(); c += step) {
      double u = 0, v = 0, x0 = 0, y0 = 0, sum = 0;
      for (int y = r - step / 2; y < std::min(r - step / 2 + step, flow.height()); ++y)
        for (int x = c - step / 2; x < std::min(c - step / 2 + step, flow.width()); ++x) {
          const double a = double(flow.u.at(x, y)), b = double(flow.v.at(x, y)), w = std::hypot(a, b);
          if (std::isfinite(w)) {
            u += w * a;
            v += w * b;
            x0 += w * x;
            y0 += w * y;
            sum += w;
          }
        }
      if (!(sum > 0)) continue;
      u /= sum;
      v /= sum;
      x0 /= sum;
      y0 /= sum;
      const double speed = std::hypot(u, v);
      if (speed < kMinArrowSpeed * full) continue;
      const double scale = 0.9 * step / std::max(full, speed);
      const cv::Point from = fixed_point({x0 - u * scale / 2, y0 - v * scale / 2}),
                      to = fixed_point({x0 + u * scale / 2, y0 + v * scale / 2});
      if (coloured) {  // hue only; the length shows the speed
        const cv::Vec3b k = wheel().colour(u / speed, v / speed);
        cv::arrowedLine(canvas, from, to, cv::Scalar(20, 20, 20), 3, cv::LINE_AA, kShift, 0.35);
        cv::arrowedLine(canvas, from, to, cv::Scalar(k[0], k[1], k[2]), 1, cv::LINE_AA, kShift, 0.35);
      } else {
        cv::arrowedLine(canvas, from, to, cv::Scalar(0, 0, 0), 1, cv::LINE_AA, kShift, 0.35);
      }
    }
}

cv::Size text_size(const std::string& words, double size) {
  int base = 0;
  return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, size, 1, &base);
}
// Dark text with a bright outline, readable on any background.
void write(cv::Mat3b canvas, const std::string& words, cv::Point at, double size) {
  cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, size, {255, 255, 255}, 3, cv::LINE_AA);
  cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, size, {30, 30, 30}, 1, cv::LINE_AA);
}

// Text beside the key; omitted when there is not enough space.
void draw_words(const cv::Mat3b& canvas, const std::string& words) {
  const double size = std::clamp(canvas.rows / 600.0, 0.4, 1.0);
  if (text_size(words, size).width > canvas.cols - canvas.rows / 5 - 16) return;
  write(canvas, words, {8, 8 + text_size(words, size).height}, size);
}

void draw_key(cv::Mat3b canvas, double full) {
  const int radius = std::clamp(std::min(canvas.rows, canvas.cols) / 14, 12, 60);
  if (std::min(canvas.rows, canvas.cols) < 6 * radius) return;
  const cv::Point centre(canvas.cols - radius - 8, radius + 8);
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) {
      const double d = std::hypot(x, y);
      if (d <= radius)
        canvas(centre.y + y, centre.x + x) = wheel().colour(double(x) / radius, double(y) / radius);
    }
  cv::circle(canvas, centre, radius, {90, 90, 90}, 1, cv::LINE_AA);
  const std::string words = fmt::format("{:.3g} px", full);
  const double size = std::clamp(radius / 40.0, 0.35, 0.8);
  const cv::Size box = text_size(words, size);
  write(canvas, words, {canvas.cols - box.width - 6, centre.y + radius + box.height + 6}, size);
}

double strength_of(const Flow& flow, const FlowDrawing& how) {
  const double full = how.full_px > 0 ? how.full_px : full_speed(flow);
  return full > 0 ? full : 1;
}

}  // namespace

double full_speed(const Flow& flow) {
  std::vector<float> speed;
  for (std::size_t i = 0; i < flow.u.px.size(); ++i)
    if (const float s = std::hypot(flow.u.px[i], flow.v.px[i]); std::isfinite(s)) speed.push_back(s);
  if (speed.empty()) return 0;
  return double(quantile_low(speed, 0.995));
}

RgbImage draw_flow(const Flow& flow, const FlowDrawing& how) {
  RgbImage out(flow.width(), flow.height());
  const double full = strength_of(flow, how);
  cv::Mat3b canvas = canvas_of(out);
  for (int r = 0; r < flow.height(); ++r)
    for (int c = 0; c < flow.width(); ++c)
      canvas(r, c) = wheel().colour(double(flow.u.at(c, r)) / full, double(flow.v.at(c, r)) / full);
  if (how.arrow_step_px > 0) draw_arrows(canvas, flow, how, full, false);
  if (how.key) draw_key(canvas, full);
  draw_words(canvas, how.words);
  return out;
}

RgbImage draw_flow_on(const GrayF& frame, const Flow& flow, const FlowDrawing& how) {
  RgbImage out(flow.width(), flow.height());
  for (std::size_t i = 0; i < frame.px.size(); ++i) {
    const auto g = cv::saturate_cast<std::uint8_t>(frame.px[i]);
    out.px[i] = {g, g, g};
  }
  const double full = strength_of(flow, how);
  cv::Mat3b canvas = canvas_of(out);
  if (how.arrow_step_px > 0) draw_arrows(canvas, flow, how, full, true);
  if (how.key) draw_key(canvas, full);
  draw_words(canvas, how.words);
  return out;
}

}  // namespace faba
