#include "vision/image/kernels/box_filter.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "vision/image/kernels/all_finite.h"
#include "vision/image/kernels/mirrored.h"

using namespace faba;

namespace {

GrayF random_picture(int w, int h) {
  std::mt19937 draws(7);
  GrayF g(w, h);
  for (float& x : g.px) x = float(draws() % 256);
  return g;
}

// The mean over a square, each from its own sum.
GrayF plain_means(const GrayF& g, int half) {
  GrayF rows(g.width, g.height), out(g.width, g.height);
  for (int r = 0; r < g.height; ++r)
    for (int c = 0; c < g.width; ++c) {
      double sum = 0;
      for (int i = -half; i <= half; ++i) sum += double(g.at(mirrored(c + i, g.width), r));
      rows.at(c, r) = float(sum / (2 * half + 1));
    }
  for (int r = 0; r < g.height; ++r)
    for (int c = 0; c < g.width; ++c) {
      double sum = 0;
      for (int i = -half; i <= half; ++i) sum += double(rows.at(c, mirrored(r + i, g.height)));
      out.at(c, r) = float(sum / (2 * half + 1));
    }
  return out;
}

}  // namespace

TEST_CASE("a box filter gives the means over squares, mirrored at the border") {
  // Sizes below and above the 16 rows of one step, not multiples of 4, and smaller than the filter.
  for (const auto& [w, h, half] :
       {std::tuple{64, 48, 3}, {37, 61, 9}, {5, 90, 8}, {90, 5, 8}, {1, 1, 4}, {19, 200, 30}}) {
    CAPTURE(w);
    CAPTURE(h);
    CAPTURE(half);
    GrayF filtered = random_picture(w, h);
    const GrayF plain = plain_means(filtered, half);
    box_filter(filtered, half, 1);
    double largest = 0;
    for (std::size_t i = 0; i < plain.px.size(); ++i)
      largest = std::max(largest, std::fabs(double(filtered.px[i]) - double(plain.px[i])));
    // Two roundings to float of values up to 255; the sums in double add nothing visible.
    CHECK(largest <= 2 * 128 * double(std::numeric_limits<float>::epsilon()));
  }
}

TEST_CASE("several filters are the same as one after the other, except for rounding") {
  for (const int times : {2, 4}) {
    GrayF together = random_picture(40, 50), each = together;
    box_filter(together, 5, times);
    for (int i = 0; i < times; ++i) box_filter(each, 5, 1);
    double largest = 0;
    for (std::size_t i = 0; i < each.px.size(); ++i)
      largest = std::max(largest, std::fabs(double(together.px[i]) - double(each.px[i])));
    // Two roundings to float per filter, in each of both.
    CHECK(largest <= 2 * 2 * times * 128 * double(std::numeric_limits<float>::epsilon()));
  }
}

TEST_CASE("one value that is not finite is found anywhere") {
  for (const float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()})
    for (const std::size_t at : {0u, 5u, 98u}) {
      GrayF g = random_picture(9, 11);
      g.px[1] = std::numeric_limits<float>::max();
      g.px[2] = -std::numeric_limits<float>::denorm_min();
      CHECK(all_finite(g));
      g.px[at] = bad;
      CHECK_FALSE(all_finite(g));
    }
}
