#include "vision/cells/stationary_cells.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "core/vec.h"

using namespace faba;

namespace {

constexpr double kWidth = 3.5;                // of a cell, px
constexpr double kSd = kWidth / 2.354820045;  // of its normal profile
constexpr double kContrast = 0.15;            // of a cell, fraction of white
constexpr double kRadius = 340;               // of the edge of the drop, px
constexpr Vec2 kCentre{160, 390};             // of the drop
constexpr Vec2 kCells[] = {{40.2, 150.7}, {90, 190}, {160.5, 120.1}, {250.3, 200.8}, {160, 50}, {280, 72.6}};

// Uneven light and the dark edge of a drop, with noise of one part in a thousand.
GrayF empty_drop(double sign) {
  GrayF g(320, 240);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.001);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const double off = std::hypot(x - kCentre.x, y - kCentre.y) - kRadius;
      const double edge = 0.25 * std::exp(-0.5 * off * off / 4);
      g.at(x, y) = float(0.5 + 0.0004 * x - sign * edge + noise(random));
    }
  return g;
}

void add_cells(GrayF& g, double amplitude) {
  for (const Vec2 at : kCells)
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        const double r = std::hypot(x - at.x, y - at.y) / kSd;
        g.at(x, y) += float(amplitude * std::exp(-0.5 * r * r));
      }
}

double largest_difference(const GrayF& a, const GrayF& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.px.size(); ++i)
    most = std::max(most, std::fabs(double(a.px[i]) - double(b.px[i])));
  return most;
}

}  // namespace

TEST_CASE("stationary cells are removed from a background, also those on the edge of a drop") {
  for (const Polarity polarity : {Polarity::dark, Polarity::bright}) {
    const double sign = polarity == Polarity::dark ? 1 : -1;
    const GrayF empty = empty_drop(sign);
    GrayF light = empty;
    add_cells(light, -sign * kContrast);
    CHECK(largest_difference(light, empty) > 0.14);
    CHECK(remove_stationary_cells(light, kWidth, kContrast, polarity) == std::size(kCells));
    // Lines are 5 degrees apart and made of pixels: at their ends, 9 px from the cell, they are up to 0.4 px
    // and 0.5 px beside the edge, whose largest slope is 0.25 / (2 px sqrt(e)) = 0.076 per px.
    CHECK(largest_difference(light, empty) < 0.9 * 0.076);
  }
}

TEST_CASE("a background without cells does not change") {
  const GrayF empty = empty_drop(1);
  GrayF light = empty;
  CHECK(remove_stationary_cells(light, kWidth, kContrast, Polarity::dark) == 0);
  CHECK(light.px == empty.px);
}
