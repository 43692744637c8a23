#include "vision/files/kernels/yuv420.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/vision/media.h"

using namespace faba;

namespace {

struct Planes {
  Planes(int w, int h) : width(w + w % 2), height(h + h % 2) {
    y.resize(std::size_t(width) * std::size_t(height), 77);
    cb.resize(y.size() / 4, 77);
    cr.resize(y.size() / 4, 77);
  }
  Yuv420Planes view() { return {y.data(), cb.data(), cr.data(), width, width / 2, width / 2}; }
  int width, height;
  std::vector<std::uint8_t> y, cb, cr;
};

// The definition in double precision.
double luma_of(Rgb p) { return 0.299 * p.r + 0.587 * p.g + 0.114 * p.b; }

}  // namespace

TEST_CASE("every grey keeps its value and has neutral chroma") {
  for (int v = 0; v < 256; ++v) {
    const auto grey = static_cast<std::uint8_t>(v);
    Planes planes(6, 4);
    to_yuv420(RgbImage(6, 4, {grey, grey, grey}), planes.view());
    CHECK(std::count(planes.y.begin(), planes.y.end(), grey) == 24);
    CHECK(std::count(planes.cb.begin(), planes.cb.end(), 128) == 6);
    CHECK(std::count(planes.cr.begin(), planes.cr.end(), 128) == 6);
  }
}

TEST_CASE("colours match the definition, for even and odd sizes") {
  // Rounding to integers: 0.5. The 16-bit weights have errors of at most 2^-17 each, times 3 channels of 255:
  // 0.006. Cb and Cr of pure blue and red are clipped from 255.5 to 255, which is within 0.5 as well.
  constexpr double kTolerance = 0.5 + 0.006;
  for (const auto& [width, height] : {std::pair{34, 20}, std::pair{37, 23}, std::pair{1, 3}}) {
    RgbImage picture(width, height);
    for (std::size_t i = 0; i < picture.px.size(); ++i) {
      const auto at = [&](std::size_t k) { return static_cast<std::uint8_t>((i * k) >> 3); };
      picture.px[i] = {at(37), at(101), at(211)};
    }
    picture.px[0] = {0, 0, 255};
    if (width > 1) picture.px[1] = {0, 0, 255};
    Planes planes(width, height);
    to_yuv420(picture, planes.view());
    const auto pixel = [&](int col, int row) {
      return picture.at(std::min(col, width - 1), std::min(row, height - 1));
    };
    double worst = 0;
    for (int row = 0; row < planes.height; ++row) {
      for (int col = 0; col < planes.width; ++col) {
        const double got = planes.y[std::size_t(row * planes.width + col)];
        worst = std::max(worst, std::abs(got - luma_of(pixel(col, row))));
      }
    }
    for (int row = 0; row < planes.height / 2; ++row) {
      for (int col = 0; col < planes.width / 2; ++col) {
        double y = 0, r = 0, b = 0;
        for (const auto p : {pixel(2 * col, 2 * row), pixel(2 * col + 1, 2 * row),
                             pixel(2 * col, 2 * row + 1), pixel(2 * col + 1, 2 * row + 1)}) {
          y += luma_of(p) / 4;
          r += p.r / 4.0;
          b += p.b / 4.0;
        }
        const auto i = std::size_t(row * planes.width / 2 + col);
        worst = std::max(worst, std::abs(planes.cb[i] - (128 + (b - y) / 1.772)));
        worst = std::max(worst, std::abs(planes.cr[i] - (128 + (r - y) / 1.402)));
      }
    }
    CHECK(worst <= kTolerance);
  }
}
