#include "study/pages/tracks/track_report.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/h5/h5.h"
#include "core/table.h"
#include "study/pages/tracks/track_json.h"
#include "tests/vision/media.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

void write_pgm(const std::filesystem::path& path, const GrayF& g) {
  const Gray8 b = cells::bytes(g);
  media::write_bytes(
      path, fmt::format("P5\n{} {}\n255\n", b.width, b.height) + std::string(b.px.begin(), b.px.end()));
}

// A folder of frames with cells that swim straight in random directions, `step` px per frame.
void swimmers(const std::filesystem::path& folder, const cells::Look& l, int n, double step, int frames) {
  cells::Dice dice(77);
  std::vector<Vec2> at, v;
  for (int i = 0; i < n; ++i) {
    at.push_back({l.width * dice.uniform(), l.height * dice.uniform()});
    const double angle = 6.283185 * dice.uniform();
    v.push_back({step * std::cos(angle), step * std::sin(angle)});
  }
  for (int k = 0; k < frames; ++k) {
    write_pgm(folder / fmt::format("f{}.pgm", k), cells::picture(l, at, std::uint64_t(500 + k)));
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = at[i] + v[i];
  }
}

// Half the mean nearest-neighbour distance of cells at random positions.
double half_spacing(const cells::Look& l, int n) {
  return 0.25 / std::sqrt(double(n) / (l.width * l.height));
}

double tracked_speed(int n, double noise) {
  const media::ScratchFolder folder;
  cells::Look l;
  l.width = 640;
  l.height = 480;
  l.noise = noise;
  const double step = 0.9 * half_spacing(l, n);
  swimmers(folder.path(), l, n, step, 14);
  TrackOptions o;
  o.video = folder.path();
  o.part.fps = 15;
  o.size_px = 3;
  return track_video(o).summary.mean_speed_px_s.value / (15 * step);
}

}  // namespace

// Displacements of 0.9 times half the mean nearest-neighbour distance: 2.8 px for 2000 cells, 8.8 px for 200.
TEST_CASE("track: mean speed of swimming cells within 5 %") {
  for (const int n : {200, 600, 2000})
    for (const double noise : {1.0, 4.0, 8.0}) {
      CAPTURE(n);
      CAPTURE(noise);
      CHECK(tracked_speed(n, noise) == doctest::Approx(1).epsilon(0.05));
    }
}

TEST_CASE("track: tables, overlay, picture, page and figures are complete and reproducible") {
  const media::ScratchFolder folder;
  std::filesystem::create_directories(folder / "frames");
  cells::Look l;
  swimmers(folder / "frames", l, 60, 4, 12);
  TrackOptions o;
  o.video = folder / "frames";
  o.part.fps = 10;
  o.scale.um_per_px = 0.5;
  o.out = {{folder / "t.csv"}, {folder / "t.h5"}};
  o.overlay = folder / "o.mp4";
  o.report = folder / "r.html";
  o.picture = folder / "p.png";
  o.figures = folder / "fig";
  o.swarm = folder / "s.csv";
  const auto j = track_json(track_video(o));
  CHECK(j["frames"] == 12);
  CHECK(j["duration_s"].get<double>() == doctest::Approx(1.1));
  CHECK(j["supported"] == "persistent_walk");
  CHECK(j["speed"]["mean_um_s"].get<double>() ==
        doctest::Approx(0.5 * j["speed"]["mean_px_s"].get<double>()));
  CHECK(j["detection"]["polarity"] == "dark");
  const Table t = read_table(folder / "t.csv");
  CHECK(t.names() == std::vector<std::string>{"track", "frame", "t_s", "x_px", "y_px", "mass", "snr"});
  CHECK(t.size() == j["points"].get<std::size_t>());
  const Table swarm = read_table(folder / "s.csv");
  CHECK(swarm.size() == 12);
  CHECK(swarm.column("signal")[0] > 0);
  const H5File h = H5File::open(folder / "t.h5");
  CHECK(h.number_attribute("/", "um_per_px") == 0.5);
  CHECK(h.table("x_px").rows() == t.size());
  for (const std::uint64_t row : {std::uint64_t{0}, std::uint64_t(t.size() - 1)}) {
    double x = 0;
    h.table("x_px").read<double>(row, {&x, 1});
    CHECK(std::fabs(x - t.column("x_px")[row]) < 6e-4);  // the CSV has three digits
  }
  for (const char* name : {"o.mp4", "r.html", "p.png", "fig/speeds.svg", "fig/msd.svg", "fig/heading.svg"})
    CHECK(std::filesystem::file_size(folder / name) > 500);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    CHECK(entry.path().extension() != ".tmp");
  const std::string csv = read_file(folder / "t.csv");
  const auto again = track_json(track_video(o));  // the same video gives the same bytes
  CHECK(read_file(folder / "t.csv") == csv);
  CHECK(again.dump() == j.dump());
}

TEST_CASE("track: unusual videos give a result or an error message") {
  const media::ScratchFolder folder;
  const auto track = [&](const char* name) {
    TrackOptions o;
    o.video = folder / name;
    o.out = {{folder / "t.csv"}};
    return track_json(track_video(o));
  };
  std::filesystem::create_directories(folder / "black");
  for (int k = 0; k < 12; ++k) write_pgm(folder / fmt::format("black/f{}.pgm", k), GrayF(90, 70));
  auto j = track("black");
  CHECK(j["tracks"] == 0);
  CHECK(j["speed"].is_null());
  CHECK(j["notes"].size() >= 2);

  std::filesystem::create_directories(folder / "one");
  cells::Look l;
  write_pgm(folder / "one/f.pgm", cells::picture(l, cells::scattered(l, 20, 12, 8, 1), 1));
  j = track("one");
  CHECK(j["tracks"] == 0);
  CHECK(j["detection"]["spots_per_frame"].get<double>() == doctest::Approx(20).epsilon(0.11));

  std::filesystem::create_directories(folder / "still");
  for (int k = 0; k < 12; ++k)
    write_pgm(folder / fmt::format("still/f{}.pgm", k),
              cells::picture(l, cells::scattered(l, 20, 12, 8, 1), std::uint64_t(k)));
  j = track("still");
  CHECK(j["detection"]["background"] == "spatial");
  CHECK(j["tracks"].get<int>() >= 19);
  CHECK(j["supported"] == "diffusion");

  write_pgm(folder / "still/f99.pgm", GrayF(50, 50));
  CHECK_THROWS_WITH_AS(track("still"), doctest::Contains("50 x 50"), Error);
  std::filesystem::create_directories(folder / "run");
  media::write_bytes(folder / "run/manifest.json", R"({"version": "0.1.0"})");
  CHECK_THROWS_WITH_AS(track("run"), doctest::Contains("the run has no video"), Error);
  media::write_bytes(folder / "run/video.mp4", "");
  CHECK_THROWS_WITH_AS(track("run"), doctest::Contains("drawing"), Error);
  CHECK(std::filesystem::exists(folder / "t.csv"));
  CHECK_FALSE(std::filesystem::exists(folder / "t.csv.tmp"));
}

TEST_CASE("track: a cancelled measurement leaves no files") {
  const media::ScratchFolder folder;
  std::filesystem::create_directories(folder / "frames");
  swimmers(folder / "frames", {}, 20, 3, 8);
  TrackOptions o;
  o.video = folder / "frames";
  o.out = {{folder / "t.csv"}, {folder / "t.h5"}};
  o.overlay = folder / "o.mp4";
  try {
    track_video(o, [](std::int64_t done, std::int64_t) { return done < 12; });
    FAIL("not cancelled");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::interrupted);
  }
  std::size_t remaining = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    remaining += entry.path().filename() != "frames";
  CHECK(remaining == 0);
}
