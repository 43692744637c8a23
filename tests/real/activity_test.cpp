// Activity in real videos: times and directions of the motion of micro-rollers, compared with a list made by
// eye; no directed motion of diffusing beads. Skipped if the videos are absent.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "study/motion/activity.h"
#include "study/pages/flow_report.h"
#include "tests/skip.h"

using namespace faba;

namespace {

const std::filesystem::path kRollers = std::filesystem::path(FABA_SHARED_DATA) / "step-response/rollers.mp4";
const std::filesystem::path kBeads = std::filesystem::path(FABA_SHARED_DATA) / "beads/bulk-water.mov";

struct Listed {
  double t0_s, t1_s, direction_deg;
};
const std::vector<Listed> kDriven{{5.6, 8.5, 270},   {12.6, 18.2, 90}, {20.5, 23.2, 90},  {25.8, 32.3, 270},
                                  {35.2, 38.4, 270}, {45.2, 58.4, 90}, {61.0, 68.9, 270}, {69.5, 73.6, 90}};

VideoActivity measured(const std::filesystem::path& video, int shrink) {
  ActivityJob job;
  job.videos.push_back({video, {}, "", {}});
  job.method = flow_part({}, published_flow());
  job.shrink = shrink;
  job.cells = false;  // faster; study.swarm_view tests the counting of cells
  return measure_activity(job).videos.at(0);
}

void compare_with_list(const std::vector<MotionSegment>& found, double slack_deg) {
  REQUIRE(found.size() == kDriven.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(std::fabs(found[i].t0_s - kDriven[i].t0_s) < 0.5);
    CHECK(std::fabs(found[i].t1_s - kDriven[i].t1_s) < 0.5);
    CHECK(std::fabs(std::remainder(found[i].direction_deg - kDriven[i].direction_deg, 360)) < slack_deg);
  }
}

}  // namespace

TEST_CASE("rollers: all field segments within 0.5 s, also at a direct reversal") {
  if (test::skipped_without(kRollers)) return;
  const VideoActivity a = measured(kRollers, 4);  // 1/16 of the pixels, because it is faster
  CHECK_FALSE(a.direction_given);
  // The list has the directions up and down; the field is tilted, and some rollers move sideways.
  compare_with_list(a.segments, 45);
  // The same flow, projected onto the direction of the list.
  compare_with_list(motion_segments(a.signature, 90), 1e-9);
}

TEST_CASE("beads in water: no motion in one direction") {
  if (test::skipped_without(kBeads)) return;
  const VideoActivity a = measured(kBeads, 2);
  CHECK(a.segments.empty());
  CHECK_FALSE(a.responds);
}
