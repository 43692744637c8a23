#include "vision/foreground/kernels/temporal_median.h"

#include <doctest/doctest.h>

#include <random>

#include "core/statistics.h"

using namespace faba;

TEST_CASE("temporal medians are those of each pixel's list, for any number of frames and pixels") {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> grey(0, 40);  // with equal values
  for (const std::size_t count : {1u, 2u, 3u, 5u, 8u, 23u, 40u, 41u}) {
    std::vector<GrayF> frames(count, GrayF(37, 3));
    for (GrayF& frame : frames)
      for (float& v : frame.px) v = 0.25F * float(grey(random));
    const std::vector<CompactImage> kept(frames.begin(), frames.end());
    GrayF median(37, 3, -1), deviation(37, 3, -1);
    const std::size_t begin = 5, end = 106;
    temporal_medians(kept, begin, end, median, deviation);
    for (std::size_t i = 0; i < median.px.size(); ++i) {
      CAPTURE(count);
      CAPTURE(i);
      if (i < begin || i >= end) {
        CHECK(median.px[i] == -1);
        continue;
      }
      std::vector<float> list;
      for (const GrayF& frame : frames) list.push_back(frame.px[i]);
      const RobustSpread<float> expected = robust_spread_low(list);
      CHECK(median.px[i] == expected.median);
      CHECK(float(kMadToSd) * deviation.px[i] == expected.sd);
    }
  }
}
