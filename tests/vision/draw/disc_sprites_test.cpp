#include "vision/draw/disc_sprites.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"

using namespace faba;

TEST_CASE("sprites are the discs of OpenCV, cut at the border of the picture") {
  constexpr int kWidth = 20, kHeight = 15, kMargin = 8;  // OpenCV draws other discs at a border
  constexpr Rgb kColour{30, 148, 74};
  for (const double radius : {0.6, 1.2, 3.0}) {
    const DiscSprites sprites(radius);
    for (const double x : {-2.0, -0.4, 0.0, 7.3, 10.0, 10.97, 19.5, 22.0})
      for (const double y : {-1.5, 0.06, 4.5, 14.9, 16.2}) {
        INFO("radius ", radius, ", at ", x, ", ", y);
        RgbImage drawn(kWidth, kHeight), expected(kWidth + 2 * kMargin, kHeight + 2 * kMargin);
        std::fill(drawn.px.begin(), drawn.px.end(), Rgb{240, 220, 200});
        std::fill(expected.px.begin(), expected.px.end(), Rgb{240, 220, 200});
        sprites.draw(drawn, x, y, kColour);
        cv::Mat m(expected.height, expected.width, CV_8UC3, expected.px.data());
        cv::circle(m, fixed_point({x + kMargin, y + kMargin}), fixed_length(radius), {30, 148, 74},
                   cv::FILLED, cv::LINE_AA, kShift);
        int most = 0;
        for (int row = 0; row < kHeight; ++row)
          for (int column = 0; column < kWidth; ++column) {
            const Rgb a = drawn.at(column, row), b = expected.at(column + kMargin, row + kMargin);
            most = std::max({most, std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
          }
        CHECK(most <= 6);  // up to three lines of the edge blend a pixel, each twice, and each blend rounds
      }
  }
}
