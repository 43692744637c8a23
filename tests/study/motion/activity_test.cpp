// Activity of rendered videos with known motion: no maximum where no motion has a direction.
#include "study/motion/activity.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "study/data/flow_choice.h"
#include "study/pages/activity_report.h"
#include "tests/rendered_video.h"
#include "tests/temporary_folder.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

/// Cells that swim from 1 s to 2 s only, with a gradual start and end; `spread_deg`: of their directions.
RenderedVideo burst(double spread_deg) {
  RenderedVideo v;
  v.fps = 30;
  v.frames = 90;
  v.microscope.cell_diameter = 4e-6;
  cells::Dice dice(5);
  std::vector<std::array<double, 3>> starts;
  for (int i = 0; i < 150; ++i)
    starts.push_back(
        {320 * dice.uniform(), 240 * dice.uniform(), spread_deg * M_PI / 180 * (dice.uniform() - 0.5)});
  v.cells = [starts](double t) {
    const double path = 15 * (1 + std::tanh((t - 1.5) / 0.25));  // px
    std::vector<CameraCell> all;
    for (const auto& [x, y, angle] : starts)
      all.push_back({float(x + path * std::cos(angle)), float(y + path * std::sin(angle))});
    return all;
  };
  return v;
}

ActivityResult measured(const RenderedVideo& v) {
  const test::TemporaryFolder folder("activity");
  write_rendered(v, folder.path() / "v.avi");
  ActivityJob job;
  job.videos = {{folder.path() / "v.avi"}};
  job.method = flow_part({}, published_flow());
  job.cells = false;
  job.threads = 1;
  return measure_activity(job);
}

}  // namespace

TEST_CASE("activity: the time of the maximum of a motion with a direction, with its standard error") {
  const ActivityResult r = measured(burst(60));
  const VideoActivity& a = r.videos.at(0);
  CHECK(a.segments.size() == 1);
  REQUIRE(a.maximum_s);
  CHECK(std::fabs(*a.maximum_s - 1.5) < 0.05);
  CHECK(activity_json(r)["videos"][0]["maximum_s"].is_number());
}

TEST_CASE("activity: no maximum of cells that swim in all directions, although their activity has one") {
  const ActivityResult r = measured(burst(360));
  const VideoActivity& a = r.videos.at(0);
  CHECK(a.segments.empty());
  CHECK(fit_gaussian(a.t_s, a.amount).good);  // a fit alone would give a maximum
  CHECK_FALSE(a.maximum_s);
  CHECK_FALSE(onset_of(a));
  CHECK(a.fit.reason.find("nothing moves in one direction") != std::string::npos);
  CHECK(activity_json(r)["videos"][0]["maximum_s"].is_null());
}
