#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "study/identify/episode_simulation.h"

using namespace faba;

TEST_CASE("a scene without boundary is valid for pictures of any size") {
  ResponseVideo v;
  v.fps = 15;
  v.um_per_px = 1;
  v.cell_px = 3;
  Episode e;
  e.segments = {{0, 5, 90}};
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{1024, 540}, std::pair{4096, 3000}}) {
    v.view.width = width;
    v.view.height = height;
    e.positions_image = {{10, 10}};
    EpisodeSettings settings;
    settings.boundary = Boundary::none;
    settings.model = {.name = "dipole", .part = {{"type", "dipole"}}};
    Document d = episode_scenario(v, e, settings, exact_timing(e));
    d.root.erase("microscope");  // its background is the video
    const double radius = d.root["arena"]["radius_px"];
    CHECK(radius > 3 * std::hypot(width, height));
    CHECK_NOTHROW((void)read_scenario(d, builtin_parts()));
  }
}
