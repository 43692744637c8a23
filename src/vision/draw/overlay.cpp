#include "vision/draw/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vision/draw/fixed_point.h"
#include "vision/drop/drop_picture.h"

namespace faba {
namespace {

// Okabe and Ito's colour-blind-safe palette.
const cv::Scalar kSky(86, 180, 233), kYellow(240, 228, 66), kOrange(255, 170, 0), kViolet(204, 121, 167);
const cv::Scalar kRim(0, 0, 0);

cv::Mat3b canvas_of(const RgbImage& picture) {
  cv::Mat3b out(picture.height, picture.width);
  std::transform(picture.px.begin(), picture.px.end(), out.begin(),
                 [](const Rgb& v) { return cv::Vec3b(v.r, v.g, v.b); });
  return out;
}

/// The visible part of the circle as short chords; OpenCV limits circles to radii of 2^15 px.
std::vector<std::vector<cv::Point>> visible_arcs(const DropEdge& edge) {
  const Vec2 c = edge.centre_image;
  const int n = std::clamp(int(2 * edge.radius_px), 64, 200000);
  std::vector<std::vector<cv::Point>> arcs(1);
  for (int i = 0; i <= n; ++i) {
    const double angle = 2 * CV_PI * i / n;
    const Vec2 p{c.x + edge.radius_px * std::cos(angle), c.y + edge.radius_px * std::sin(angle)};
    if (p.x > -8 && p.y > -8 && p.x < edge.image_width + 7 && p.y < edge.image_height + 7)
      arcs.back().push_back(fixed_point(p));
    else if (!arcs.back().empty())
      arcs.emplace_back();
  }
  return arcs;
}

/// One drawing layer: all shapes in their colour at `width`, or all in black as the rim below.
class Pen {
 public:
  Pen(cv::Mat3b canvas, int width, bool rim) : canvas_(std::move(canvas)), width_(width), rim_(rim) {}

  void line(Vec2 a, Vec2 b, const cv::Scalar& colour) {
    cv::line(canvas_, fixed_point(a), fixed_point(b), ink(colour), stroke(), cv::LINE_AA, kShift);
  }
  void path(const std::vector<cv::Point>& points, const cv::Scalar& colour) {
    cv::polylines(canvas_, points, false, ink(colour), stroke(), cv::LINE_AA, kShift);
  }
  void ring(Vec2 at, double radius, const cv::Scalar& colour) {
    cv::circle(canvas_, fixed_point(at), fixed_length(radius), ink(colour), stroke(), cv::LINE_AA, kShift);
  }
  void dot(Vec2 at, double radius, const cv::Scalar& colour) {
    cv::circle(canvas_, fixed_point(at), fixed_length(radius + (rim_ ? 1 : 0)), ink(colour), cv::FILLED,
               cv::LINE_AA, kShift);
  }

 private:
  cv::Scalar ink(const cv::Scalar& colour) const { return rim_ ? kRim : colour; }
  int stroke() const { return rim_ ? width_ + 2 : width_; }

  cv::Mat3b canvas_;
  int width_;
  bool rim_;
};

RgbImage rgb_image(const cv::Mat3b& m) {
  RgbImage out(m.cols, m.rows);
  std::transform(m.begin(), m.end(), out.px.begin(), [](const cv::Vec3b& v) {
    return Rgb{v[0], v[1], v[2]};
  });
  return out;
}

int pen_width(const RgbImage& picture) {
  return std::max(1, int(std::lround(std::min(picture.width, picture.height) / 500.0)));
}

void draw(Pen pen, const DropEdge& edge, int width) {
  const Vec2 c = edge.centre_image;
  const double unit = width;
  for (const EdgeSegment& s : edge.segments) pen.line(s.a, s.b, kViolet);
  for (const auto& arc : visible_arcs(edge)) pen.path(arc, kSky);
  // Minimum distance between dots, so that the circle remains visible.
  const double dot_spacing = 14 * unit;
  Vec2 last{-1e9, -1e9};
  for (Vec2 p : edge.edge_points) {
    if (norm(p - last) < dot_spacing) continue;
    pen.dot(p, 1.6 * unit, kYellow);
    last = p;
  }
  if (c.x >= 0 && c.y >= 0 && c.x < edge.image_width && c.y < edge.image_height) {
    pen.line(c - Vec2{9 * unit, 0}, c + Vec2{9 * unit, 0}, kSky);
    pen.line(c - Vec2{0, 9 * unit}, c + Vec2{0, 9 * unit}, kSky);
  }
  pen.ring(edge.inside_image, 5 * unit, kOrange);
}

}  // namespace

RgbImage drop_overlay(const RgbImage& picture, const DropEdge& edge) {
  if (picture.empty()) return {};
  cv::Mat3b m = canvas_of(picture), rims = m.clone();
  const int width = pen_width(picture);
  draw(Pen(rims, width, true), edge, width);
  cv::addWeighted(m, 0.4, rims, 0.6, 0, m);
  draw(Pen(m, width, false), edge, width);
  return rgb_image(m);
}

Gray8 edge_pixel_picture(const GrayF& picture, const DropEdgeOptions& options) {
  const DropPicture prepared = prepare_drop_picture(picture, options);
  Gray8 out(picture.width, picture.height);
  for (const EdgePixel& p : find_edge_segments(prepared.levels[0].flat, options.edges).pixels)
    out.at(std::clamp(int(std::lround(p.pos.x)), 0, out.width - 1),
           std::clamp(int(std::lround(p.pos.y)), 0, out.height - 1)) = 255;
  return out;
}

RgbImage hough_picture(const RgbImage& picture, const DropEdge& edge) {
  if (picture.empty()) return {};
  cv::Mat3b m = canvas_of(picture);
  m.convertTo(m, -1, 0.5);
  Pen pen(m, 2 * pen_width(picture), false);
  for (const EdgeSegment& s : edge.segments) pen.line(s.a, s.b, kViolet);
  return rgb_image(m);
}

}  // namespace faba
