// Flows that a reading of samples keeps are those that a complete reading computes, and are used once.
#include "study/data/kept_flows.h"

#include <doctest/doctest.h>

#include <cmath>

#include "study/data/flow_choice.h"
#include "study/data/flow_source.h"
#include "tests/rendered_video.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

std::vector<FlowPair> pairs_of(const std::filesystem::path& video, const FlowSourceOptions& options) {
  FlowSource source(video, options);
  std::vector<FlowPair> pairs;
  for (FlowPair pair; source.next(pair);) pairs.push_back(pair);
  return pairs;
}

}  // namespace

TEST_CASE("a complete reading takes the kept flows, with the same result") {
  const test::TemporaryFolder folder("kept-flows");
  const auto file = folder.path() / "v.avi";
  RenderedVideo v;
  v.width = 64;
  v.height = 48;
  v.frames = 13;
  v.cells = [](double t) {
    const auto s = float(t);
    return std::vector<CameraCell>{{20 + 9 * s, 24, 0, 0}, {40, 10 + 8 * s, 0, 0}};
  };
  write_rendered(v, file);

  FlowSourceOptions options;
  options.method = flow_part(FlowChoice{});
  options.threads = 2;
  options.t0_s = 0.1;  // frame 2
  const std::vector<FlowPair> computed = pairs_of(file, options);

  options.kept = std::make_shared<KeptFlows>();
  options.samples = 4;
  const std::vector<FlowPair> sampled = pairs_of(file, options);
  REQUIRE(sampled.size() > 2);
  REQUIRE(sampled.size() < computed.size());
  // A kept flow that is changed must be found again in the result: it was not computed a second time.
  const std::uint64_t marked = sampled[1].frame;
  Flow changed = *options.kept->take(marked);
  CHECK(changed.u.px == sampled[1].flow.u.px);
  changed.u.px[0] += 1;
  options.kept->keep(marked, changed);
  options.samples = 0;
  const std::vector<FlowPair> pairs = pairs_of(file, options);
  REQUIRE(pairs.size() == computed.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Flow expected = pairs[k].frame == marked ? changed : computed[k].flow;
    CHECK(pairs[k].frame == computed[k].frame);
    CHECK(pairs[k].flow.u.px == expected.u.px);
    CHECK(pairs[k].flow.v.px == expected.v.px);
    CHECK(pairs[k].image->px == computed[k].image->px);
    CHECK_FALSE(options.kept->take(pairs[k].frame));
  }
}

TEST_CASE("kept flows need a limited amount of memory") {
  KeptFlows kept;
  Flow large;
  large.u = large.v = GrayF(4096, 4096);  // 128 MiB
  for (std::uint64_t frame = 0; frame < 3; ++frame) kept.keep(frame, large);
  CHECK(kept.take(0));
  CHECK(kept.take(1));
  CHECK_FALSE(kept.take(2));
  kept.keep(4, large);
  CHECK(kept.take(4));
}
