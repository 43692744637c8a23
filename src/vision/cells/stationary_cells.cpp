#include "vision/cells/stationary_cells.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace faba {
namespace {

constexpr int kDirections =
    36;  // of lines through a pixel: between two the edge of a drop stays within 0.5 px
constexpr double kLongest = 5;  // cell widths: a cell is visible over about two, and it diffuses
// Fraction of the contrast of a cell. A cell that is stationary for half of the time leaves no trace in a
// background.
constexpr double kFaintest = 0.25;

// A line through the middle of a square of `side` pixels, symmetric about the middle.
cv::Mat line(int side, double angle) {
  cv::Mat kernel = cv::Mat::zeros(side, side, CV_8U);
  const int half = side / 2;
  for (int k = 0; k <= half; ++k) {
    const int dx = int(std::lround(k * std::cos(angle))), dy = int(std::lround(k * std::sin(angle)));
    kernel.at<uchar>(half + dy, half + dx) = kernel.at<uchar>(half - dy, half - dx) = 1;
  }
  return kernel;
}

}  // namespace

std::size_t remove_stationary_cells(GrayF& light, double cell_px, double contrast, Polarity polarity) {
  const bool bright = polarity == Polarity::bright;
  cv::Mat picture(light.height, light.width, CV_32F, light.px.data()), filled, along;
  const int side = 2 * int(std::lround(kLongest * cell_px / 2)) + 1;
  // A closing along a line fills dark gaps that are shorter than the line. What is dark along one direction
  // for longer than that stays dark in the darkest of all directions.
  for (int k = 0; k < kDirections; ++k) {
    cv::morphologyEx(picture, along, bright ? cv::MORPH_OPEN : cv::MORPH_CLOSE,
                     line(side, CV_PI * k / kDirections));
    if (k == 0)
      filled = along.clone();
    else if (bright)
      cv::max(filled, along, filled);
    else
      cv::min(filled, along, filled);
  }
  const cv::Mat depth = cv::abs(filled - picture);
  cv::Mat spots = depth > kFaintest * contrast, labels;
  const int count = cv::connectedComponents(spots, labels) - 1;
  // The blurred rim of a spot is fainter than the limit.
  cv::dilate(spots, spots,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(side / 2 | 1, side / 2 | 1)));
  filled.copyTo(picture, spots);
  return std::size_t(count);
}

}  // namespace faba
