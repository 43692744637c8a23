#include <doctest/doctest.h>

#include <cmath>

#include "study/identify/response/response_survey.h"
#include "tests/rendered_video.h"
#include "tests/temporary_folder.h"
#include "vision/drop/drop_edge.h"

using namespace faba;

namespace {

const Circle kDrop{{-40, 120}, 319};

// Cells at the right edge, which swim to the left from 0.6 s on, each at its own speed.
std::vector<CameraCell> swarm_at(double t) {
  std::vector<CameraCell> cells;
  for (int i = 0; i < 600; ++i) {
    const double y = 5 + 230 * std::fmod(0.618034 * i, 1.0), depth = 3 * std::fmod(0.754878 * i, 1.0),
                 speed = 50 + 20 * std::fmod(0.569840 * i, 1.0);
    const double edge =
        kDrop.centre.x + std::sqrt(std::pow(kDrop.radius, 2) - std::pow(y - kDrop.centre.y, 2));
    CameraCell cell;
    cell.x = float(edge - depth - speed * std::max(0.0, t - 0.6));
    cell.y = float(y);
    cells.push_back(cell);
  }
  return cells;
}

double edge_on_axis(const DropEdge& e) { return e.centre_image.x + e.radius_px; }

}  // namespace

TEST_CASE("a swarm at the edge of a drop does not shift the edge that a response has") {
  RenderedVideo video;
  video.frames = 60;
  video.edge = kDrop;
  video.microscope.cell_diameter = 2.5e-6;
  video.microscope.noise = 0.01;
  video.cells = swarm_at;
  const test::TemporaryFolder folder("drop-response");
  const auto file = folder.path() / "video.avi";
  write_rendered(video, file);

  ResponseInput input;
  input.file = file;
  input.um_per_px = 1;
  input.threads = 1;
  input.segments = {{0.6, 3.9, 180}};
  const ResponseVideo response = survey_response(input, Boundary::drop, Measure::density, [] {});
  const double truth = kDrop.centre.x + kDrop.radius;
  CHECK(edge_on_axis(*response.edge) == doctest::Approx(truth).epsilon(0.3 / truth));
}
