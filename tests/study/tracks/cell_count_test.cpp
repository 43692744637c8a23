#include "study/tracks/cell_count.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/error.h"
#include "tests/vision/media.h"
#include "tests/vision/rendered_cells.h"
#include "vision/flow/flow_file.h"

using namespace faba;

namespace {

std::optional<double> visible_cells(
    const std::filesystem::path& path, const VideoPart& part, unsigned threads = 2,
    const std::function<void()>& check = [] {}) {
  CellCount count(path, part, threads);
  if (!count.reads_frames()) return count.mean();
  count.read(count.survey(), check);
  count.end_survey();
  count.read(count.count(), check);
  return count.mean();
}

}  // namespace

TEST_CASE("visible cells: detected in a video, read from the series of a run, unknown for flows") {
  const media::ScratchFolder folder;
  std::filesystem::create_directories(folder / "frames");
  cells::Look l;
  auto swarm = cells::scattered(l, 90, 12, 8, 3);
  for (int k = 0; k < 12; ++k) {
    const Gray8 b = cells::bytes(cells::picture(l, swarm, std::uint64_t(k)));
    media::write_bytes(
        folder / fmt::format("frames/f{}.pgm", k),
        fmt::format("P5\n{} {}\n255\n", b.width, b.height) + std::string(b.px.begin(), b.px.end()));
    for (Vec2& p : swarm) p.x += 3;
  }
  double in_view = 0;
  for (const Vec2& p : swarm) in_view += p.x - 18 < l.width;  // in the middle of the video
  const double counted = *visible_cells(folder / "frames", {});
  CHECK(counted == doctest::Approx(in_view).epsilon(0.1));
  for (const unsigned threads : {1u, 3u}) CHECK(*visible_cells(folder / "frames", {}, threads) == counted);
  const auto stop = [] { throw Error(Errc::interrupted, "", "stopped"); };
  CHECK_THROWS_AS(visible_cells(folder / "frames", {}, 2, stop), Error);
  CHECK_FALSE(visible_cells(folder / "frames", {.from_s = 100}));

  std::filesystem::create_directories(folder / "run");
  media::write_bytes(folder / "run/manifest.json", R"({"version": "0.1.0"})");
  media::write_bytes(folder / "run/series.csv", "frame,t_s,visible_count\n0,0,10\n1,0.1,20\n");
  CHECK(*visible_cells(folder / "run", {}) == 15);
  CHECK(*visible_cells(folder / "run", {.from_s = 0.05}) == 20);

  FlowFileWriter flows(folder / "flow.h5", {8, 8, 15, {}, "{}", "test"});
  flows.write(1, 0, 0.1, {GrayF(8, 8), GrayF(8, 8)});
  flows.close();
  CHECK_FALSE(visible_cells(folder / "flow.h5", {}));
}
