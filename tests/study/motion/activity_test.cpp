// Activity of rendered videos with known motion: no maximum where no motion has a direction.
#include "study/motion/activity.h"

#include <doctest/doctest.h>

#include <cmath>

#include "study/data/flow_choice.h"
#include "study/pages/activity_report.h"
#include "tests/rendered_burst.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

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
