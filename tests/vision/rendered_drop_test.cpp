// The drop edge drawn by the renderer and the detected drop edge agree; the two implementations are
// independent.
#include <doctest/doctest.h>

#include <cmath>

#include "core/random/philox.h"
#include "tests/rendered_video.h"
#include "vision/drop/drop_edge.h"

using namespace faba;

TEST_CASE(
    "the edge of a rendered drop is detected within its reported error: complete, a quarter, and 25 degrees "
    "of the circle") {
  struct Arc {
    Circle drop;
    double degrees;
  };
  for (const Arc& arc :
       {Arc{{{315, 243}, 190}, 360}, Arc{{{560, 240}, 340}, 87}, Arc{{{1180, 240}, 1100}, 24.5}})
    for (const std::uint64_t seed : {1U, 2U}) {
      RenderedVideo v;
      v.width = 640;
      v.height = 480;
      v.m_per_px = 0.9164e-6;
      v.frames = 1;
      v.edge = arc.drop;
      v.seed = seed;
      v.cells = [&](double) {
        std::vector<CameraCell> cells;
        for (std::uint32_t i = 0; cells.size() < 300; ++i) {
          const auto w = draw(seed, Stream::start, i, 0);
          const Vec2 at{640 * double(uniform(w[0])), 480 * double(uniform(w[1]))};
          if (norm(at - arc.drop.centre) < arc.drop.radius) cells.push_back({float(at.x), float(at.y)});
        }
        return cells;
      };
      GrayF grey(v.width, v.height);
      render_frames(v,
                    [&](const Gray8& picture, int) { grey.px.assign(picture.px.begin(), picture.px.end()); });
      const DropEdge found = find_drop_edge(grey);
      CAPTURE(arc.degrees);
      // four reported standard deviations: one failure in 16 000 per number
      CHECK(std::fabs(found.radius_px - arc.drop.radius) < 4 * found.sd_radius_px);
      CHECK(std::fabs(found.centre_image.x - arc.drop.centre.x) < 4 * found.sd_centre_px.x + 0.05);
      CHECK(std::fabs(found.centre_image.y - arc.drop.centre.y) < 4 * found.sd_centre_px.y + 0.05);
      CHECK(found.sd_radius_px < 1);
      CHECK(std::fabs(found.arc_deg - arc.degrees) < 0.1 * arc.degrees);
      CHECK(found.centre_side_inside);
    }
}
