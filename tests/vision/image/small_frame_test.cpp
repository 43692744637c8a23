#include "vision/image/small_frame.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

using namespace faba;

namespace {

// Rounded mean of a square of n x n px.
std::uint8_t mean_of(const Gray8& picture, int n, int column, int row) {
  double sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) sum += picture.at(column * n + x, row * n + y);
  return std::uint8_t(std::floor(sum / (n * n) + 0.5));
}

}  // namespace

TEST_CASE("small_picture: rounded means of squares, incomplete squares omitted, grey and colour") {
  const std::vector<std::pair<int, int>> sizes{{320, 7}, {321, 5}, {641, 10}, {1000, 9}, {4000, 40}};
  for (const auto& [width, height] : sizes) {
    const int n = (width + 319) / 320;
    Gray8 grey(width, height);
    RgbImage colour(width, height);
    for (std::size_t i = 0; i < grey.px.size(); ++i) {
      grey.px[i] = std::uint8_t(i * 7919 % 256);
      colour.px[i] = {grey.px[i], std::uint8_t(255 - grey.px[i]), 255};
    }
    Gray8 inverse = grey;
    for (auto& g : inverse.px) g = std::uint8_t(255 - g);
    const RgbImage a = small_picture(grey), b = small_picture(colour);
    REQUIRE(a.width == width / n);
    REQUIRE(a.height == height / n);
    REQUIRE(b.px.size() == a.px.size());
    for (int row = 0; row < a.height; ++row)
      for (int column = 0; column < a.width; ++column) {
        const std::uint8_t g = mean_of(grey, n, column, row);
        REQUIRE(a.at(column, row) == Rgb{g, g, g});
        REQUIRE(b.at(column, row) == Rgb{g, mean_of(inverse, n, column, row), 255});
      }
  }
}
