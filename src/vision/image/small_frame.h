#pragma once
#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "vision/image/image.h"

namespace faba {

/// A reduced picture of a video for a report.
struct SmallFrame {
  RgbImage picture;
  double t_s = 0;
};

constexpr int kSmallFrameWidth = 320;  // px, maximum

/// The picture averaged over squares of n x n px, with the smallest n for which it is at most
/// kSmallFrameWidth wide; incomplete squares at the right and lower edge are omitted. Pixel: Rgb or uint8_t.
template <class Pixel>
RgbImage small_picture(const Image<Pixel>& picture) {
  const int n = std::max(1, (picture.width + kSmallFrameWidth - 1) / kSmallFrameWidth);
  const auto colour = [](Pixel p) {
    if constexpr (std::is_same_v<Pixel, Rgb>)
      return p;
    else
      return Rgb{p, p, p};
  };
  const auto mean = [n](int sum) { return std::uint8_t((sum + n * n / 2) / (n * n)); };
  RgbImage out(picture.width / n, picture.height / n);
  for (int r = 0; r < out.height; ++r)
    for (int c = 0; c < out.width; ++c) {
      int red = 0, green = 0, blue = 0;
      for (int i = 0; i < n * n; ++i) {
        const Rgb p = colour(picture.at(c * n + i % n, r * n + i / n));
        red += p.r;
        green += p.g;
        blue += p.b;
      }
      out.at(c, r) = {mean(red), mean(green), mean(blue)};
    }
  return out;
}

}  // namespace faba
