#include "vision/image/small_frame.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace faba {
namespace {

template <class Pixel>
RgbImage reduced(const Image<Pixel>& picture) {
  constexpr int kChannels = sizeof(Pixel);
  static_assert(kChannels == 1 || std::is_same_v<Pixel, Rgb>);
  const int n = std::max(1, (picture.width + kSmallFrameWidth - 1) / kSmallFrameWidth);
  RgbImage out(picture.width / n, picture.height / n);
  const std::size_t values = std::size_t(picture.width) * kChannels;
  std::vector<std::uint32_t> sums(values);  // over n rows
  for (int r = 0; r < out.height; ++r) {
    std::fill(sums.begin(), sums.end(), 0u);
    for (int i = 0; i < n; ++i) {
      const auto* row = reinterpret_cast<const std::uint8_t*>(picture.px.data()) +
                        values * (std::size_t(r) * std::size_t(n) + std::size_t(i));
      for (std::size_t k = 0; k < values; ++k) sums[k] += row[k];
    }
    const auto mean = [&](int column, int channel) {
      std::uint32_t sum = 0;
      for (int i = 0; i < n; ++i) sum += sums[std::size_t(column * n + i) * kChannels + std::size_t(channel)];
      return std::uint8_t((sum + std::uint32_t(n * n / 2)) / std::uint32_t(n * n));
    };
    for (int c = 0; c < out.width; ++c)
      out.at(c, r) = {mean(c, 0), mean(c, kChannels / 2), mean(c, kChannels - 1)};
  }
  return out;
}

}  // namespace

RgbImage small_picture(const RgbImage& picture) { return reduced(picture); }
RgbImage small_picture(const Gray8& picture) { return reduced(picture); }

}  // namespace faba
