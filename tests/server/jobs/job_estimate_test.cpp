#include "server/jobs/job_estimate.h"

#include <doctest/doctest.h>

#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

Job done(const char* kind, double work, double seconds) {
  Job j{.kind = kind, .work = work, .state = Job::State::done};
  j.seconds = seconds;
  return j;
}

}  // namespace

TEST_CASE("the time of a job is estimated from the initial values until one is complete") {
  const JobKind& k = job_kind("track");
  const JobEstimate first = estimate_job(k, 100, {});
  CHECK_FALSE(first.measured);
  CHECK(first.seconds == doctest::Approx(k.fixed_s + 100 * k.s_per_work));
  // 2 s per megapixel, and an interrupted and a foreign job that do not count.
  Job cancelled = done("track", 10, 1000);
  cancelled.state = Job::State::cancelled;
  const std::vector<Job> jobs = {done("track", 10, k.fixed_s + 20), cancelled, done("flow", 10, 9999)};
  const JobEstimate next = estimate_job(k, 100, jobs);
  CHECK(next.measured);
  CHECK(next.seconds == doctest::Approx(k.fixed_s + 200));
}

TEST_CASE("a job that was faster than the constant part still gives a rate") {
  const JobKind& k = job_kind("identify");
  const std::vector<Job> jobs = {done("identify", 100, k.fixed_s / 2)};
  CHECK(estimate_job(k, 10000, jobs).seconds == doctest::Approx(k.fixed_s + 100 * 0.2 * k.fixed_s / 2));
}

TEST_CASE("one job that took much longer does not change the estimate") {
  const JobKind& k = job_kind("drop");
  CHECK(estimate_job(k, 0, {done("drop", 0, 2), done("drop", 0, 100), done("drop", 0, 3)}).seconds == 3);
}

TEST_CASE("the work of a comparison of controllers: trials, frames and cells") {
  test::TemporaryFolder folder("job-estimate");
  fs::create_directories(folder.path() / "studies");
  write_file(
      folder.path() / "scene.toml",
      "duration = '2 s'\n[camera]\nrate = '15 Hz'\n[arena]\ntype = 'drop'\nradius_px = 100\n[[swarm]]\ncount "
      "= "
      "100\n[controller]\ntype = 'proportional'\n[reference]\ntype = 'hold'\nsetpoint_px = [330, 250]\n");
  write_file(folder.path() / "studies/s.toml",
             "scene = '../scene.toml'\nseeds = 10\ndelays = [0, 1]\n[[controller]]\ntype = 'proportional'\n"
             "[[controller]]\ntype = 'fuzzy'\n");
  const Workspace w(folder.path(), {});
  // 2 controllers, 2 delays, 10 seeds, 30 frames, 100 cells
  CHECK(work_of(job_kind("compare-controllers"), {{"study", "studies/s.toml"}}, w) == doctest::Approx(0.12));
}

TEST_CASE("the work of a library: sets of currents") {
  test::TemporaryFolder folder("job-estimate");
  write_file(folder.path() / "r.toml", "[[coil]]\ntype = 'loop'\n[[coil]]\ntype = 'loop'\n");
  const Workspace w(folder.path(), {});
  CHECK(work_of(job_kind("field-library"), {{"rig", "r.toml"}, {"levels", 20}}, w) ==
        doctest::Approx(400e-6));
  CHECK(work_of(job_kind("field-library"), {{"rig", "r.toml"}}, w) == doctest::Approx(0.01));
}
