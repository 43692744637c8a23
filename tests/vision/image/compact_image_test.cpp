#include "vision/image/compact_image.h"

#include <doctest/doctest.h>

#include <bit>
#include <limits>
#include <random>

#include "vision/image/kernels/grey_scale.h"

using namespace faba;

namespace {

constexpr int kWidth = 347, kHeight = 101;  // more than one block, and no multiple of a vector

GrayF integer_greys(int most) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> grey(0, most);
  GrayF image(kWidth, kHeight);
  for (float& v : image.px) v = float(grey(random));
  image.px.back() = float(most);
  return image;
}

// The bytes per pixel that it takes. Checks that each value is the same to the bit.
double bytes_per_pixel(const GrayF& image) {
  const CompactImage compact(image);
  const GrayF back = compact.image();
  CHECK(back.width == image.width);
  CHECK(back.height == image.height);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < image.px.size(); ++i)
    differ += std::bit_cast<std::uint32_t>(back.px[i]) == std::bit_cast<std::uint32_t>(image.px[i]) ? 0 : 1;
  CHECK(differ == 0);
  const std::size_t begin = 1003, n = 77;
  std::vector<float> part(n);
  compact.copy(begin, n, part.data());
  for (std::size_t i = 0; i < n; ++i)
    CHECK(std::bit_cast<std::uint32_t>(part[i]) == std::bit_cast<std::uint32_t>(image.px[begin + i]));
  return double(compact.bytes()) / double(image.px.size());
}

}  // namespace

TEST_CASE("a compact image has the values of the image in the fewest bytes") {
  CHECK(bytes_per_pixel(integer_greys(255)) == 1);
  GrayF limited = integer_greys(255);  // as luma, also below black and above white
  const GreyMap luma{16, 255.0F / 219, 255};
  for (float& v : limited.px) v = luma(v);
  CHECK(bytes_per_pixel(limited) == 1);
  CHECK(bytes_per_pixel(integer_greys(256)) == 2);
  CHECK(bytes_per_pixel(integer_greys(65535)) == 2);
  CHECK(bytes_per_pixel(integer_greys(65536)) == 4);
  for (const int side : {2, 3, 4}) {
    CAPTURE(side);
    GrayF average;
    shrink(integer_greys(255), side, average);
    CHECK(bytes_per_pixel(average) == (side == 3 ? 4 : 2));
  }
}

TEST_CASE("a compact image can be replaced by another one of any kind") {
  CompactImage compact(integer_greys(255));
  for (const int most : {65536, 255, 65535, 255}) {
    const GrayF image = integer_greys(most);
    compact.assign(image);
    CHECK(compact.image().px == image.px);
  }
  compact.assign(GrayF(3, 2, 7));
  CHECK(compact.image().width == 3);
  CHECK(compact.image().px == GrayF(3, 2, 7).px);
}

TEST_CASE("a compact image has values that are no grey levels, too") {
  const float inf = std::numeric_limits<float>::infinity();
  for (const float odd :
       {-1.0F, -0.0F, 0.1F, 1e-40F, 3e9F, inf, -inf, std::numeric_limits<float>::quiet_NaN()})
    for (const std::size_t at : {std::size_t(0), std::size_t(kWidth * kHeight - 1)}) {
      CAPTURE(odd);
      GrayF image = integer_greys(255);
      image.px[at] = odd;
      CHECK(bytes_per_pixel(image) == 4);
    }
}
