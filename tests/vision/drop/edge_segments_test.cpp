#include "vision/drop/edge_segments.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/vision/drop_pictures.h"

using namespace faba;

namespace {

/// Dark left of column `from`, bright from column `from`.
GrayF half_plane(int from) {
  GrayF im(160, 96, 50.f);
  for (int r = 0; r < im.height; ++r)
    for (int c = from; c < im.width; ++c) im.at(c, r) = 90;
  return im;
}

}  // namespace

TEST_CASE("an edge between columns 99 and 100 is at 99.5, with its normal from dark to bright") {
  for (const auto threshold :
       {EdgeThreshold::legacy, EdgeThreshold::otsu, EdgeThreshold::noise, EdgeThreshold::fixed}) {
    EdgeSegmentOptions options;
    options.threshold = threshold;
    options.fixed_threshold = 3;
    const EdgeSegments found = find_edge_segments(half_plane(100), options);
    REQUIRE(found.support.size() > 80);  // of 95 rows; the border is excluded
    for (const EdgePixel& p : found.support) {
      CHECK(p.pos.x == 99.5);
      CHECK(p.normal.x == doctest::Approx(1));
    }
    REQUIRE(found.segments.size() == 1);
    CHECK(found.segments[0].a.x == doctest::Approx(99.5));
    CHECK(std::fabs(found.segments[0].a.y - found.segments[0].b.y) > 80);
  }
}

TEST_CASE("rows and columns are distinguished") {
  GrayF im(160, 96, 90.f);
  for (int r = 40; r < im.height; ++r)
    for (int c = 0; c < im.width; ++c) im.at(c, r) = 50;
  const EdgeSegments found = find_edge_segments(im);
  REQUIRE(found.segments.size() == 1);
  CHECK(found.segments[0].a.y == doctest::Approx(39.5));
  CHECK(std::fabs(found.segments[0].a.x - found.segments[0].b.x) > 140);
  for (const EdgePixel& p : found.support) CHECK(p.normal.y == doctest::Approx(-1));
}

TEST_CASE("the legacy threshold is the root of six mean squared gradients") {
  EdgeSegmentOptions options;
  options.sigma_px = 0;
  // Without smoothing one of 159 columns has gradient 40, the others 0.
  CHECK(find_edge_segments(half_plane(100), options).threshold ==
        doctest::Approx(std::sqrt(6 * 1600.0 / 159)));
}

TEST_CASE("scattered cells and noise give edge pixels, but no segments") {
  DropScene scene;
  scene.cells = 60;
  const EdgeSegments found = find_edge_segments(render(scene));
  CHECK(found.pixels.size() > 500);
  // A cell is about 8 px wide; a segment of 40 px with gaps of up to 20 px needs several cells in a row.
  CHECK(found.support.size() < found.pixels.size() / 4);
}

TEST_CASE("the limits on segments and pixels hold, and an empty picture gives no edges") {
  DropScene scene;
  scene.noise = 20;
  EdgeSegmentOptions options;
  options.threshold = EdgeThreshold::fixed;
  options.fixed_threshold = 0.1;
  options.max_edge_pixels = 3000;
  options.max_segments = 5;
  const EdgeSegments found = find_edge_segments(render(scene), options);
  CHECK(found.pixels.size() <= 3000);
  CHECK(found.segments.size() <= 5);
  CHECK(find_edge_segments(GrayF(40, 30, 7.f)).pixels.empty());
  CHECK(find_edge_segments(GrayF()).segments.empty());
}
