// Theory A17: histograms, alignment, and the distances for comparison.
#include "study/motion/compare.h"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <random>

#include "study/pages/flow_report.h"
#include "tests/study/made_flows.h"
#include "tests/temporary_folder.h"
#include "vision/flow/flow_file.h"

using namespace faba;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// A file of flows, 10 pairs per second: no motion, to the right from pair `first`, to the left from
/// `second`.
void write_step(const std::filesystem::path& file, int pairs, int first, int second, double speed,
                unsigned seed, int height = 20) {
  std::mt19937 g(seed);
  std::normal_distribution<double> noise(0, 0.1);
  FlowFileWriter w(file, {32, height, 10, {}, "{}", "made"});
  for (int k = 0; k < pairs; ++k) {
    FlowPair p = test::moving_quarter(std::uint64_t(k),
                                      k < first    ? 0
                                      : k < second ? speed
                                                   : -speed,
                                      0, 32, height);
    for (float& x : p.flow.u.px) x += float(noise(g));
    for (float& x : p.flow.v.px) x += float(noise(g));
    w.write(p.frame, p.t0_s, p.t1_s, p.flow);
  }
  w.close();
}

CompareJob job_of(const std::filesystem::path& reference, const std::vector<std::filesystem::path>& runs) {
  CompareJob job;
  job.reference = reference;
  job.runs = runs;
  job.method = flow_part({}, published_flow());
  job.threads = 1;
  job.flow_threshold_px = 0.5;  // five standard deviations of the noise
  return job;
}

}  // namespace

TEST_CASE("histograms agree with their definition") {
  std::mt19937 g(1);
  std::normal_distribution<float> gauss(0, 1);
  Flow f{GrayF(7, 5), GrayF(7, 5)};
  for (float& x : f.u.px) x = gauss(g);
  for (float& x : f.v.px) x = gauss(g);
  const FlowFilter filter{0.6, 200};
  FlowHistograms h;
  flow_histograms(f, filter, 2, h);
  const Flow kept = filtered_flow(f, filter);
  for (int c = 0; c < 7; ++c) {
    double legacy = 0, right = 0, left = 0, picture = 0;
    for (int r = 0; r < 5; ++r) {
      const double u = double(f.u.at(c, r)), v = double(f.v.at(c, r)), speed = std::hypot(u, v);
      if (speed <= 0.6) continue;
      (u > 0 ? right : left) += 2 * std::fabs(u);
      if (u * std::cos(200 * kDegree) + v * std::sin(200 * kDegree) >= std::cos(45 * kDegree) * speed)
        legacy += 2 * std::fabs(u);
      picture += 2 * std::fabs(double(kept.u.at(c, r)));
    }
    // Sums of five floats of magnitude 1.
    CHECK(h.x[std::size_t(c)] == doctest::Approx(legacy).epsilon(1e-6));
    CHECK(h.right[std::size_t(c)] == doctest::Approx(right).epsilon(1e-6));
    CHECK(h.left[std::size_t(c)] == doctest::Approx(left).epsilon(1e-6));
    CHECK(h.x[std::size_t(c)] == doctest::Approx(picture).epsilon(1e-6));
  }
}

TEST_CASE("the distance of a video to itself is 0, and that to a video without motion is large") {
  const test::TemporaryFolder f("compare");
  write_step(f.path() / "a.h5", 100, 20, 50, 1, 1);
  const Comparison c = compare_videos(job_of(f.path() / "a.h5", {f.path() / "a.h5"}));
  CHECK(c.runs[0].distance.mean == 0);
  CHECK(c.runs[0].distance.sd == 0);
  CHECK(c.runs[0].distance.line.slope == 0);
  CHECK(c.runs[0].distance.legacy_mean == 0);
  CHECK(c.naive.mean > 1);
  CHECK_FALSE(c.noise_floor);
  CHECK(c.noise_floor_from.find("none of the compared inputs is a run directory") != std::string::npos);
}

TEST_CASE("reference and run are aligned at the reversal") {
  const test::TemporaryFolder f("compare");
  write_step(f.path() / "a.h5", 100, 20, 50, 1, 1);
  write_step(f.path() / "b.h5", 120, 30, 63, 1, 2);
  CompareJob job = job_of(f.path() / "a.h5", {f.path() / "b.h5"});
  const Comparison found = compare_videos(job);
  // The reversal is detected to within one pair.
  CHECK(std::fabs(found.reference_t0_s - 5) <= 0.11);
  CHECK(std::fabs(found.runs[0].t0_s - 6.3) <= 0.11);
  CHECK(std::fabs(std::remainder(found.filter.direction_deg - 180, 360)) < 5);
  job.align = false;
  const Comparison unaligned = compare_videos(job);
  CHECK(unaligned.runs[0].distance.mean > 1.5 * found.runs[0].distance.mean);
  job.reference_t0_s = 5;
  job.t0_s = 6.3;
  job.align = true;
  job.duration_s = 2;
  const Comparison given = compare_videos(job);
  CHECK(given.reference_t0_s == 5);
  CHECK(given.runs[0].distance.t_s.size() == 20);
  CHECK(given.runs[0].distance.mean < 0.2 * given.naive.mean);
}

TEST_CASE("a slower run has a larger distance; a run of another size or without overlap is refused") {
  const test::TemporaryFolder f("compare");
  write_step(f.path() / "a.h5", 100, 20, 50, 1, 1);
  write_step(f.path() / "same.h5", 100, 20, 50, 1, 2);
  write_step(f.path() / "slow.h5", 100, 20, 50, 0.6, 3);
  write_step(f.path() / "small.h5", 100, 20, 50, 1, 4, 12);
  const auto c = compare_videos(job_of(f.path() / "a.h5", {f.path() / "same.h5", f.path() / "slow.h5"}));
  CHECK(c.runs[1].distance.mean > 2 * c.runs[0].distance.mean);
  CHECK_THROWS_AS(compare_videos(job_of(f.path() / "a.h5", {f.path() / "small.h5"})), Error);
  CompareJob late = job_of(f.path() / "a.h5", {f.path() / "same.h5"});
  late.reference_t0_s = 9.9;
  late.t0_s = 0;
  CHECK_THROWS_AS(compare_videos(late), Error);
}
