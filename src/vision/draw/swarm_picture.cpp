#include "vision/draw/swarm_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"
#include "vision/draw/scale_bar.h"

namespace faba {
namespace {

// Okabe-Ito colours, safe for colour-blind readers.
constexpr Rgb kSwarm[] = {{30, 48, 74}, {0, 114, 178}, {213, 94, 0}, {146, 90, 20}}, kPale{178, 182, 190};
const cv::Scalar kGround{247, 246, 242}, kOutside{214, 214, 208}, kEdge{120, 120, 112};
const cv::Scalar kGreen{0, 158, 115}, kPurple{160, 40, 160}, kLabel{60, 60, 60};
const cv::Scalar kObstacle{248, 222, 206}, kObstacleEdge{213, 94, 0};
constexpr std::size_t kManyCells = 20000;  // above, a cell is one pixel: discs would cover each other

void line(cv::Mat& m, Vec2 a, Vec2 b, const cv::Scalar& colour, int thickness = 1) {
  cv::line(m, fixed_point(a), fixed_point(b), colour, thickness, cv::LINE_AA, kShift);
}

void cross(cv::Mat& m, Vec2 at, double arm, const cv::Scalar& colour) {
  line(m, {at.x - arm, at.y}, {at.x + arm, at.y}, colour, 2);
  line(m, {at.x, at.y - arm}, {at.x, at.y + arm}, colour, 2);
}

void text(cv::Mat& m, const std::string& s, cv::Point at, double size) {
  cv::putText(m, s, at, cv::FONT_HERSHEY_SIMPLEX, size, {250, 250, 248}, 3, cv::LINE_AA);  // halo
  cv::putText(m, s, at, cv::FONT_HERSHEY_SIMPLEX, size, kLabel, 1, cv::LINE_AA);
}

void ground(cv::Mat& m, const SwarmScene& s) {
  if (s.background && s.background->width == s.width && s.background->height == s.height) {
    for (int y = 0; y < m.rows; ++y)
      for (int x = 0; x < m.cols; ++x) {
        const auto g = std::uint8_t(150 + s.background->at(x, y) * 100 / 255);
        m.at<cv::Vec3b>(y, x) = {g, g, g};
      }
    return;
  }
  m.setTo(s.edge_radius_px > 0 ? kOutside : kGround);
  if (s.edge_radius_px > 0)
    cv::circle(m, fixed_point(s.edge_centre), fixed_length(s.edge_radius_px), kGround, cv::FILLED,
               cv::LINE_AA, kShift);
}

void obstacle(cv::Mat& m, const std::vector<Vec2>& polygon) {
  std::vector<cv::Point> corners;
  corners.reserve(polygon.size());
  for (const Vec2 corner : polygon) corners.push_back(fixed_point(corner));
  cv::fillPoly(m, std::vector{corners}, kObstacle, cv::LINE_AA, kShift);
  cv::polylines(m, std::vector{corners}, true, kObstacleEdge, 1, cv::LINE_AA, kShift);
}

void scale_bar(cv::Mat& m, const SwarmScene& s) {
  const ScaleBar bar = scale_bar_for(s.width, s.um_per_px);
  const double x = 12, y = s.height - 14;
  cv::rectangle(m, cv::Point(int(x), int(y)), cv::Point(int(std::lround(x + bar.length_px)), int(y) + 3),
                kLabel, cv::FILLED);
  text(m, bar.label, {int(x), int(y) - 6}, 0.45);
}

// Length 40 px at 100 uT, proportional to the square root, so that 20 uT and 2 mT are both visible.
void field_arrow(cv::Mat& m, const SwarmScene& s) {
  const double b = norm(s.field_ut);
  const Vec2 at{s.width - 44.0, s.height - 44.0};
  cv::circle(m, fixed_point(at), 2 << kShift, kLabel, cv::FILLED, cv::LINE_AA, kShift);
  if (b > 0.05) {
    const double length = std::min(40.0, 4 * std::sqrt(b));
    const Vec2 d{s.field_ut.x / b, -s.field_ut.y / b}, tip = at + length * d, across{-d.y, d.x};
    line(m, at, tip, kLabel, 2);
    line(m, tip, tip - 7 * d + 4 * across, kLabel, 2);
    line(m, tip, tip - 7 * d - 4 * across, kLabel, 2);
  }
  const std::string label = b < 0.05 ? "B = 0" : fmt::format("{:.0f} uT", b);
  text(m, label, {s.width - 44 - int(4.2 * double(label.size())), 24}, 0.45);
}

}  // namespace

SwarmPicture::SwarmPicture(const SwarmScene& s) : ground_(s.width, s.height), disc_(s.cell_radius_px) {
  cv::Mat m(s.height, s.width, CV_8UC3, ground_.px.data());
  ground(m, s);
  if (s.edge_radius_px > 0)
    cv::circle(m, fixed_point(s.edge_centre), fixed_length(s.edge_radius_px), kEdge, 1, cv::LINE_AA, kShift);
  for (const std::vector<Vec2>& polygon : s.obstacles) obstacle(m, polygon);
  for (std::size_t i = 1; i < s.route.size(); ++i) line(m, s.route[i - 1], s.route[i], {210, 160, 210});
}

void SwarmPicture::draw_cells(const SwarmScene& s, RgbImage& picture) const {
  const bool discs = s.cells.size() <= kManyCells;
  for (const SwarmScene::Cell& c : s.cells) {
    const Rgb colour = c.responding ? kSwarm[c.swarm % 4] : kPale;
    if (discs) {
      disc_.draw(picture, double(c.x), double(c.y), colour);
      continue;
    }
    const long x = std::lround(c.x), y = std::lround(c.y);
    if (x >= 0 && y >= 0 && x < s.width && y < s.height) picture.at(int(x), int(y)) = colour;
  }
}

void SwarmPicture::draw(const SwarmScene& s, RgbImage& out) const {
  out = ground_;
  cv::Mat m(s.height, s.width, CV_8UC3, out.px.data());
  draw_cells(s, out);
  if (s.setpoint) cross(m, *s.setpoint, 10, kPurple);
  if (s.second_setpoint) cross(m, *s.second_setpoint, 10, kPurple);
  if (s.centroid) cross(m, *s.centroid, 7, kGreen);
  if (s.width >= 160 && s.height >= 120) {  // smaller pictures have no space for text
    scale_bar(m, s);
    field_arrow(m, s);
    text(m, fmt::format("{:.2f} s", s.t), {12, 24}, 0.5);
  }
}

}  // namespace faba
