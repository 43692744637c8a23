#include "vision/draw/track_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"

namespace faba {
namespace {

// Okabe-Ito palette without black and yellow, which have low contrast on grey.
const cv::Scalar kInks[] = {{0, 114, 178},   {213, 94, 0},  {0, 158, 115},
                            {204, 121, 167}, {230, 159, 0}, {86, 180, 233}};

}  // namespace

RgbImage draw_tracks(const GrayF& frame, float black, float white, const std::vector<TrackLine>& tracks,
                     bool rings, double ring_px) {
  RgbImage out(frame.width, frame.height);
  if (frame.empty()) return out;
  const float gain = white > black ? 255.0F / (white - black) : 0.0F;
  std::transform(frame.px.begin(), frame.px.end(), out.px.begin(), [&](float v) {
    const auto g = std::uint8_t(std::lround(std::clamp((v - black) * gain, 0.0F, 255.0F)));
    return Rgb{g, g, g};
  });
  cv::Mat m(out.height, out.width, CV_8UC3, out.px.data());
  const int width = std::max(1, int(std::lround(std::min(m.cols, m.rows) / 700.0)));
  for (const TrackLine& t : tracks) {
    const cv::Scalar& ink = kInks[t.number % std::size(kInks)];
    std::vector<cv::Point> points;
    for (const Vec2 p : t.path) points.push_back(fixed_point(p));
    cv::polylines(m, points, false, ink, width, cv::LINE_AA, kShift);
    if (rings && t.seen && !points.empty())
      cv::circle(m, points.back(), fixed_length(ring_px), ink, width, cv::LINE_AA, kShift);
  }
  return out;
}

}  // namespace faba
