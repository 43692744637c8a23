#include "vision/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/picture.h"

namespace faba {
namespace {

constexpr int kShift = 4;

cv::Point fixed(Vec2 p) {
  const auto f = [](double v) { return int(std::lround(std::clamp(v, -3e4, 3e4) * (1 << kShift))); };
  return {f(p.x), f(p.y)};
}

void cross(cv::Mat& m, Vec2 at, double arm, const cv::Scalar& colour) {
  cv::line(m, fixed({at.x - arm, at.y}), fixed({at.x + arm, at.y}), colour, 2, cv::LINE_AA, kShift);
  cv::line(m, fixed({at.x, at.y - arm}), fixed({at.x, at.y + arm}), colour, 2, cv::LINE_AA, kShift);
}

}  // namespace

RgbImage drop_overlay(const GrayF& picture, const DropEdge& edge) {
  const Gray8 grey = stretched(picture);
  RgbImage out(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.px.size(); ++i) out.px[i] = {grey.px[i], grey.px[i], grey.px[i]};
  cv::Mat m(out.height, out.width, CV_8UC3, out.px.data());
  const cv::Scalar points{86, 180, 233}, circle{230, 159, 0}, inside{0, 158, 115};
  for (const Vec2 p : edge.edge_points)
    cv::circle(m, fixed(p), 1 << kShift, points, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(m, fixed(edge.centre_image), int(std::lround(edge.radius_px * (1 << kShift))), circle, 1,
             cv::LINE_AA, kShift);
  cross(m, edge.centre_image, 8, circle);
  cv::circle(m, fixed(edge.inside_image), 5 << kShift, inside, 2, cv::LINE_AA, kShift);
  return out;
}

}  // namespace faba
