#include "vision/image/coding_traces.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

std::vector<CompactImage> kept(const std::vector<GrayF>& frames) { return {frames.begin(), frames.end()}; }

// Noise of `sd` around 100; with a step, the difference from the first frame is rounded to multiples of it in
// blocks of 8 px, as the mean of each block only, like a coarse quantiser of a transform.
std::vector<GrayF> frames(double sd, double step, std::uint64_t seed) {
  cells::Dice dice(seed);
  std::vector<GrayF> all;
  for (int k = 0; k < 6; ++k) {
    GrayF g(160, 120);
    for (float& v : g.px) v = float(std::round(100 + sd * dice.normal()));
    if (step > 0 && k > 0)
      for (int top = 0; top < g.height; top += 8)
        for (int left = 0; left < g.width; left += 8) {
          const auto change = float(step * std::round(dice.normal()));
          for (int y = top; y < top + 8; ++y)
            for (int x = left; x < left + 8; ++x) g.at(x, y) = all[0].at(x, y) + change;
        }
    all.push_back(std::move(g));
  }
  return all;
}

}  // namespace

TEST_CASE("coding traces: noise and moving objects have none") {
  Pool pool(2);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<GrayF> all = frames(2, 0, seed);
    cells::Dice dice(100 + seed);
    for (GrayF& g : all)  // bright squares of 8 px at random places
      for (int i = 0; i < 12; ++i) {
        const int left = int(dice.uniform() * 150), top = int(dice.uniform() * 110);
        for (int y = top; y < top + 8; ++y)
          for (int x = left; x < left + 8; ++x) g.at(x, y) += 40;
      }
    const CodingTraces t = coding_traces(kept(all), pool);
    CHECK_MESSAGE(!t.coded(), "seed " << seed << ": " << t.block_steps << ", " << t.significance);
    CHECK(t.unchanged == 0);
  }
}

TEST_CASE("coding traces: changes in blocks, and blocks that are copied") {
  Pool pool(2);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const CodingTraces t = coding_traces(kept(frames(2, 1, seed)), pool);
    CHECK(t.coded());
    CHECK(t.unchanged > 0.1);
  }
}

TEST_CASE("coding traces: frames that are equal, small or missing") {
  Pool pool(2);
  CHECK_FALSE(coding_traces({}, pool).coded());
  CHECK_FALSE(coding_traces(kept({GrayF(40, 200, 1), GrayF(40, 200, 2)}), pool).coded());
  const CodingTraces t = coding_traces(kept({GrayF(100, 80, 7), GrayF(100, 80, 7)}), pool);
  CHECK_FALSE(t.coded());
  CHECK(t.unchanged == 1);
}

TEST_CASE("the noise of coded blocks is not that of the copied ones") {
  cells::Dice dice(3);
  GrayF difference(160, 160), response(160, 160);
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 40; ++x) {  // a quarter is coded
      difference.at(x, y) = 1;
      response.at(x, y) = float(3 * dice.normal());
    }
  // Relative standard error of an 80 % quantile of |normal| from 6400 values: 1.6 %.
  CHECK(double(coded_noise(difference, response)) == doctest::Approx(3).epsilon(0.08));
  CHECK(coded_noise(GrayF(160, 160), response) == 0);
}
