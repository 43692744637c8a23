#include "study/motion/kernels/correlation_window.h"

#include <doctest/doctest.h>

#include "core/random/draw_blocks.h"
#include "core/random/philox.h"

using namespace faba;

TEST_CASE("correlation: sums of products for each displacement, with zeros outside the picture") {
  constexpr int kRadius = 9;
  GrayF second(37, 23);
  for (int i = 0; i < int(second.px.size()); ++i)
    second.px[std::size_t(i)] = float(draw(7, Stream::study, 0, std::uint32_t(i))[0] % 16);
  std::vector<SparsePixel> first;
  for (std::uint32_t i = 0; i < 50; ++i) {
    const auto w = draw(7, Stream::study, 1, i);
    first.push_back({int(w[0] % 37), int(w[1] % 23), float(w[2] % 16)});
  }
  CorrelationWindow window(kRadius);
  const auto inside = [](int dx, int dy) { return dx + 2 * dy >= -3 && dx + 2 * dy <= 8; };
  for (int dy = -kRadius; dy <= kRadius; ++dy)
    for (int dx = -kRadius; dx <= kRadius; ++dx)
      if (inside(dx, dy)) window.include(dx, dy);
  const CorrelationSums sums = window.sums(first, second);
  for (int dy = -kRadius; dy <= kRadius; ++dy)
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      if (!inside(dx, dy)) continue;
      float expected = 0;  // of small integers: exact
      for (const SparsePixel& p : first) {
        const int c = p.col + dx, r = p.row + dy;
        if (c >= 0 && r >= 0 && c < second.width && r < second.height) expected += p.value * second.at(c, r);
      }
      CHECK(sums.at(dx, dy) == expected);
    }
}
