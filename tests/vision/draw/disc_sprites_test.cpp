#include "vision/draw/disc_sprites.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"

using namespace faba;

TEST_CASE("sprites are blended by the coverage of OpenCV's discs, and cut at the border of the picture") {
  constexpr int kWidth = 20, kHeight = 15, kMargin = 8;  // OpenCV draws other discs at a border
  constexpr Rgb kColour{30, 148, 74}, kBehind{240, 220, 200};
  for (const double radius : {0.6, 1.2, 3.0}) {
    const DiscSprites sprites(radius);
    for (const double x : {-2.0, -0.4, 0.0, 7.3, 10.0, 10.97, 19.5, 22.0})
      for (const double y : {-1.5, 0.06, 4.5, 14.9, 16.2}) {
        INFO("radius ", radius, ", at ", x, ", ", y);
        RgbImage drawn(kWidth, kHeight);
        std::fill(drawn.px.begin(), drawn.px.end(), kBehind);
        sprites.draw(drawn, x, y, kColour);
        Gray8 coverage(kWidth + 2 * kMargin, kHeight + 2 * kMargin);
        cv::Mat m(coverage.height, coverage.width, CV_8UC1, coverage.px.data());
        m.setTo(0);
        cv::circle(m, fixed_point({x + kMargin, y + kMargin}), fixed_length(radius), 255, cv::FILLED,
                   cv::LINE_AA, kShift);
        double most = 0;
        for (int row = 0; row < kHeight; ++row)
          for (int column = 0; column < kWidth; ++column) {
            const Rgb p = drawn.at(column, row);
            const double c = coverage.at(column + kMargin, row + kMargin) / 255.0;
            most = std::max({most, std::fabs(p.r - (1 - c) * kBehind.r - c * kColour.r),
                             std::fabs(p.g - (1 - c) * kBehind.g - c * kColour.g),
                             std::fabs(p.b - (1 - c) * kBehind.b - c * kColour.b)});
          }
        // OpenCV rounds the points of the edge to 1/16 px, and at ties to the even number, so that discs at
        // the same place within a pixel differ by this step. The largest contrast is 240 - 30.
        CHECK(most <= 0.5 + 210 / 16.0);
      }
  }
}
