#include "app/files/position_table.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "app/recording/session.h"
#include "core/error.h"
#include "tests/app/run_directory.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

constexpr std::uint64_t kCells = 5000, kRows = 23, kChunkRows = 8;  // two chunks across, two and a part along
constexpr PositionTable::Rounding kSixtyFourth{1.0 / 64, {319.5, 239.5}};

// Cells at random positions on both ends of the range, so that some differences exceed 16 bits.
std::vector<float> row(std::uint64_t k) {
  std::mt19937 draws{std::uint32_t(k)};
  std::vector<float> xy(2 * kCells);
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const double reach = 32767.0 / 64, u = double(draws()) / 4294967295.0;
    xy[i] = float((i % 2 ? 239.5 : 319.5) + reach * (2 * u - 1));
  }
  return xy;
}

RunOptions into(const std::filesystem::path& dir) {
  RunOptions o;
  o.out = dir;
  o.threads = 2;
  return o;
}

}  // namespace

TEST_CASE("rounded positions: within half of the resolution, in any order of reading") {
  const test::TemporaryFolder folder("positions");
  const auto path = folder.path() / "tracks.h5";
  {
    H5File file = H5File::create(path);
    PositionTable table(file, kCells, kChunkRows, true, kSixtyFourth);
    file.begin_writing();
    for (std::uint64_t k = 0; k < kRows; ++k) table.append(row(k));
    CHECK_THROWS_AS(table.append(std::vector<float>(2 * kCells, 900.0F)), Error);
    file.close();
  }
  const H5File file = H5File::open(path);
  PositionTable table(file);
  REQUIRE(table.rows() == kRows);
  REQUIRE(table.cells() == kCells);
  std::vector<float> xy(2 * kCells);
  for (const std::uint64_t k : {0, 1, 2, 7, 8, 9, 22, 21, 3, 15, 15, 16}) {
    CAPTURE(k);
    table.read(k, xy);
    const std::vector<float> exact = row(k);
    double largest = 0;
    for (std::size_t i = 0; i < xy.size(); ++i)
      largest = std::max(largest, std::fabs(double(xy[i]) - double(exact[i])));
    CHECK(largest <= 0.5 / 64);
    CHECK(largest > 0.4 / 64);  // they are rounded
  }
}

TEST_CASE("exact positions are read as they were written") {
  const test::TemporaryFolder folder("positions");
  const auto path = folder.path() / "tracks.h5";
  {
    H5File file = H5File::create(path);
    PositionTable table(file, kCells, kChunkRows, false, {});
    file.begin_writing();
    table.append(row(1));
    file.close();
  }
  const H5File file = H5File::open(path);
  std::vector<float> xy(2 * kCells);
  PositionTable(file).read(0, xy);
  CHECK(xy == row(1));
}

TEST_CASE(
    "a run with rounded positions, stopped and resumed, has the same positions; too fine ones are refused") {
  const TestFolder f;
  const char* text = R"(
duration = "4 s"
arena = { type = "box", size_px = [200, 150] }
record = { resolution_px = 0.015625, video = false, checkpoint = "1000 s" }
[[swarm]]
count = 50
model = "basic"
)";
  const auto positions = [](const std::filesystem::path& dir) {
    const H5File file = H5File::open(dir / "tracks.h5");
    PositionTable table(file);
    std::vector<float> all, xy(2 * table.cells());
    for (std::uint64_t k = 0; k < table.rows(); ++k) {
      table.read(k, xy);
      all.insert(all.end(), xy.begin(), xy.end());
    }
    return all;
  };
  const Scenario scene = scenario_from(text);
  Session complete = Session::begin(scene, 7, into(f.path / "complete"));
  REQUIRE(complete.run());
  {
    std::atomic<bool> stop{false};
    RunOptions o = into(f.path / "cut");
    o.stop = &stop;
    o.progress = [&](std::uint64_t done, std::uint64_t) { stop = done == 31; };
    CHECK_FALSE(Session::begin(scene, 7, o).run());
  }
  Session resumed = Session::resume(builtin_parts(), into(f.path / "cut"));
  REQUIRE(resumed.run());
  CHECK(positions(f.path / "cut") == positions(f.path / "complete"));

  std::string fine = text;
  fine.replace(fine.find("0.015625"), 8, "0.001");
  CHECK_THROWS_WITH_AS(Session::begin(scenario_from(fine), 7, into(f.path / "fine")),
                       doctest::Contains("record.resolution_px: 0.001 px is too fine for 16 bits"), Error);
}
