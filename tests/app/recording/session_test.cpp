#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "app/recording/checkpoint.h"
#include "core/h5/h5.h"
#include "tests/app/run_directory.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

// All features with internal state: noise, reversals, exposure, delay, integrator, route, slew limit.
constexpr const char* kScene = R"(
duration = "4 s"
exposure = "200 s"
motility = "thesis"
camera = { rate = "20 Hz", delay_frames = 2 }
arena = { type = "drop", radius_px = 150, view_px = [320, 200], centre_px = [160, 100] }
limits = { max_slew = "40 A/s" }
estimator = "visible"
controller = { type = "proportional", actuation = "duty", integral_gain = 0.05, max_output = 20 }
reference = { type = "route", setpoints_px = [[80, 60], [240, 140]] }
record = { checkpoint = "1000 s", lossless = true }
[[swarm]]
count = 120
model = { type = "dipole", reversal_rate = "0.2 Hz", tumble_rate = "0.1 Hz" }
)";

RunOptions options(const std::filesystem::path& out, unsigned threads = 1) {
  RunOptions o;
  o.out = out;
  o.threads = threads;
  return o;
}

std::string state_hash(const Session& s) { return s.manifest().simulated->state_hash; }

/// Begins a run and stops it after frame `last`.
struct Stopped {
  Stopped(const Scenario& scene, std::uint64_t last, const std::filesystem::path& out) {
    std::atomic<bool> stop{false};
    RunOptions o = options(out);
    o.stop = &stop;
    o.progress = [&](std::uint64_t done, std::uint64_t) { stop = done == last; };
    Session s = Session::begin(scene, 7, o);
    complete = s.run();
    frames = s.manifest().frames;
  }
  bool complete = false;
  std::uint64_t frames = 0;  ///< recorded
};

}  // namespace

TEST_CASE("a complete run directory has all files and no marker") {
  const TestFolder f;
  Session s = Session::begin(scenario_from(kScene), 7, options(f.path / "run"));
  CHECK(std::filesystem::exists(f.path / "run/incomplete"));
  CHECK(s.run());
  s.complete();
  CHECK_FALSE(std::filesystem::exists(f.path / "run/incomplete"));
  CHECK_FALSE(std::filesystem::exists(f.path / "run/checkpoint"));
  for (const char* name :
       {"manifest.json", "scenario.toml", "series.csv", "tracks.h5", "video.mp4", "video.avi"})
    CHECK_MESSAGE(std::filesystem::exists(f.path / "run" / name), name);
  CHECK_FALSE(std::filesystem::exists(f.path / "run/video.mp4.part"));

  const H5File tracks = H5File::open(f.path / "run/tracks.h5");
  CHECK(tracks.number_attribute("/", "fps") == 20);
  CHECK(tracks.number_attribute("/", "um_per_px") == doctest::Approx(0.9164));
  CHECK(tracks.table("position_px").rows() == 80);
  CHECK(tracks.table("position_px").row_size() == 240);
  CHECK(tracks.table("responding").rows() == 80);
}

TEST_CASE("a part of a run is recorded from the same run: rows, positions, frames and state hash are equal") {
  const TestFolder f;
  Scenario scene = scenario_from(kScene);
  scene.record.flow = true;
  Session complete = Session::begin(scene, 7, options(f.path / "complete"));
  REQUIRE(complete.run());
  scene.record.from = 1.03;  // the first frame after it is the one at 1.05 s
  scene.record.to = 3;
  Session part = Session::begin(scene, 7, options(f.path / "part", 2));
  REQUIRE(part.run());
  CHECK(state_hash(part) == state_hash(complete));

  const Table all = complete.series(), some = part.series();
  REQUIRE(some.size() == 39);
  CHECK(some.column("frame")[0] == 21);
  CHECK(some.column("t_s")[38] == doctest::Approx(2.95));
  for (const std::string& name : some.names())
    for (std::size_t k = 0; k < some.size(); ++k) {
      const double a = some.column(name)[k], b = all.column(name)[k + 21];
      REQUIRE((a == b || (std::isnan(a) && std::isnan(b))));
    }
  const H5File a = H5File::open(f.path / "part/tracks.h5"), b = H5File::open(f.path / "complete/tracks.h5");
  const H5Table ta = a.table("position_px"), tb = b.table("position_px");
  REQUIRE(ta.rows() == 39);
  std::vector<float> ra(ta.row_size()), rb(tb.row_size());
  ta.read<float>(38, ra);
  tb.read<float>(59, rb);
  CHECK(ra == rb);
  VideoReader va(f.path / "part/video.avi"), vb(f.path / "complete/video.avi");
  GrayF pa, pb;
  double t = 0;
  for (int k = 0; k <= 21; ++k) REQUIRE(vb.read(pb, t));
  REQUIRE(va.read(pa, t));
  CHECK(pa.px == pb.px);
  CHECK(H5File::open(f.path / "part/flow.h5").table("u_px").rows() == 38);

  const Manifest m = part.manifest();
  CHECK(m.frames == 39);
  CHECK(m.duration_s == doctest::Approx(1.95));
  REQUIRE(m.recorded_s);
  CHECK(m.recorded_s->x == doctest::Approx(1.05));
  CHECK(m.recorded_s->y == doctest::Approx(3));
  CHECK(manifest_json(m)["recorded_s"].size() == 2);
  CHECK_FALSE(manifest_json(complete.manifest()).contains("recorded_s"));
  CHECK(part.frames().size() == 6);
  CHECK(std::any_of(m.notes.begin(), m.notes.end(), [](const std::string& note) {
    return note.find("the part from 1.05 s to 3 s of a run of 4 s") != note.npos;
  }));
}

TEST_CASE("a run that records a part, stopped before and in the part and resumed, has the same files") {
  const TestFolder f;
  Scenario scene = scenario_from(kScene);
  scene.record.from = 1;
  Session complete = Session::begin(scene, 7, options(f.path / "complete"));
  REQUIRE(complete.run());
  for (const std::uint64_t stop_at : {5u, 40u}) {
    INFO("stopped after frame ", stop_at);
    const auto dir = f.path / ("stopped-" + std::to_string(stop_at));
    const Stopped stopped(scene, stop_at, dir);
    CHECK_FALSE(stopped.complete);
    CHECK(stopped.frames == (stop_at < 20 ? 0 : stop_at - 20));
    Session resumed = Session::resume(builtin_parts(), options(dir));
    REQUIRE(resumed.run());
    CHECK(state_hash(resumed) == state_hash(complete));
    CHECK(read_file(dir / "series.csv") == read_file(f.path / "complete/series.csv"));
    CHECK(read_file(dir / "video.avi") == read_file(f.path / "complete/video.avi"));
    CHECK(H5File::open(dir / "tracks.h5").table("position_px").rows() == 60);
  }
}

TEST_CASE("the video of a part starts at 0 s and has the times of its frames") {
  const TestFolder f;
  const Scenario scene = scenario_from(R"(
duration = "2 s"
camera = { rate = "20 Hz", jitter = "5 ms" }
controller = { type = "manual", field = ["1 mT", "0 T"] }
record = { from = 1, video_every = 3, tracks_every = 2 }
[[swarm]]
count = 10
)");
  Session part = Session::begin(scene, 7, options(f.path / "part"));
  REQUIRE(part.run());
  const Table series = part.series();
  REQUIRE(series.size() == 20);
  VideoReader video(f.path / "part/video.mp4");
  GrayF picture;
  double t = 0;
  std::size_t frames = 0;
  for (; video.read(picture, t); ++frames)
    CHECK(t == doctest::Approx(series.column("t_s")[3 * frames] - series.column("t_s")[0]).epsilon(1e-4));
  CHECK(frames == 7);
  const H5File tracks = H5File::open(f.path / "part/tracks.h5");
  const H5Table numbers = tracks.table("frame");
  REQUIRE(numbers.rows() == 10);
  std::uint64_t number = 0;
  numbers.read<std::uint64_t>(0, {&number, 1});
  CHECK(number == 20);
}

TEST_CASE("a recorded part must contain a frame of the run") {
  const std::string scene = std::string("duration = 4\n[[swarm]]\ncount = 1\n[record]\n");
  const auto refused = [&](const std::string& record, const char* why) {
    CHECK_THROWS_WITH_AS(scenario_from(scene + record), doctest::Contains(why), const Error&);
  };
  refused("from = 4", "record.from: 4 s is not before the end of the run at 4 s");
  refused("from = 2\nto = 2", "record.to: 2 s is not after record.from = 2 s");
  refused("from = 2\nto = 1", "record.to: 1 s is not after record.from = 2 s");
  refused("from = -1", "record.from");
  CHECK_NOTHROW(scenario_from(scene + "from = 2\nto = 90"));
  // Not part of what is simulated.
  CHECK(scenario_from(scene + "from = 2").hash() == scenario_from(scene).hash());
}

TEST_CASE("the resolved scenario of a run gives the same run again") {
  const TestFolder f;
  Session first = Session::begin(scenario_from(kScene), 7, options(f.path / "a"));
  first.run();
  const Scenario again = read_scenario(read_toml(f.path / "a/scenario.toml"), builtin_parts());
  CHECK(again.resolved() == first.scenario().resolved());
  REQUIRE(again.params.seed == 7u);
  Session second = Session::begin(again, *again.params.seed, options(f.path / "b", 3));
  second.run();
  CHECK(state_hash(second) == state_hash(first));
  CHECK(read_file(f.path / "a/series.csv") == read_file(f.path / "b/series.csv"));
}

TEST_CASE("R5: a run stopped after any frame and resumed has the same files as an uninterrupted one") {
  const TestFolder f;
  const Scenario scene = scenario_from(kScene);
  Session complete = Session::begin(scene, 7, options(f.path / "complete"));
  REQUIRE(complete.run());
  for (const std::uint64_t stop_at : {1u, 7u, 40u, 79u, 80u}) {
    INFO("stopped after frame ", stop_at);
    const auto dir = f.path / ("stopped-" + std::to_string(stop_at));
    CHECK(Stopped(scene, stop_at, dir).complete == (stop_at == 80));
    CHECK(std::filesystem::exists(dir / "incomplete"));
    Session resumed =
        Session::resume(builtin_parts(), options(dir, 2));  // with a different number of threads
    REQUIRE(resumed.run());
    CHECK(state_hash(resumed) == state_hash(complete));
    CHECK(read_file(dir / "series.csv") == read_file(f.path / "complete/series.csv"));
    const H5File a = H5File::open(dir / "tracks.h5"), b = H5File::open(f.path / "complete/tracks.h5");
    const H5Table ta = a.table("position_px"), tb = b.table("position_px");
    REQUIRE(ta.rows() == tb.rows());
    std::vector<float> ra(ta.row_size()), rb(tb.row_size());
    for (std::uint64_t r = 0; r < ta.rows(); ++r) {
      ta.read<float>(r, ra);
      tb.read<float>(r, rb);
      REQUIRE(ra == rb);
    }
  }
}

TEST_CASE("a run with rendered frames, stopped and resumed, has bit-identical frames and the same times") {
  const TestFolder f;
  const Scenario scene = scenario_from(R"(
duration = "1.2 s"
camera = { rate = "20 Hz", delay_frames = 2, sensor = "frames", jitter = "5 ms" }
microscope = { cell_length = "3 um", flicker = 0.01, depth_spread = "3 um", bits = 16 }
arena = { type = "drop", radius_px = 150, view_px = [121, 90], centre_px = [160, 45] }
controller = { type = "manual", field = ["1 mT", "0 T"] }
record = { checkpoint = "1000 s", lossless = true, as_seen = true }
[[swarm]]
count = 60
)");
  Session complete = Session::begin(scene, 7, options(f.path / "complete"));
  REQUIRE(complete.run());
  CHECK_FALSE(Stopped(scene, 9, f.path / "cut").complete);
  Session resumed = Session::resume(builtin_parts(), options(f.path / "cut", 2));
  REQUIRE(resumed.run());
  CHECK(state_hash(resumed) == state_hash(complete));
  CHECK(read_file(f.path / "cut/series.csv") == read_file(f.path / "complete/series.csv"));
  // PNG has no state between frames, so the position of checkpoints has no effect
  CHECK(read_file(f.path / "cut/video.avi") == read_file(f.path / "complete/video.avi"));
  CHECK(complete.manifest().video_shows == "camera");

  VideoReader avi(f.path / "cut/video.avi"), mp4(f.path / "cut/video.mp4");
  CHECK(avi.bits() == 16);
  CHECK(avi.width() == 121);
  const H5File tracks = H5File::open(f.path / "cut/tracks.h5");
  const H5Table times = tracks.table("t_s");
  GrayF a, b;
  double ta = 0, tb = 0, truth = 0;
  std::uint64_t k = 0;
  for (; avi.read(a, ta); ++k) {
    REQUIRE(mp4.read(b, tb));
    times.read<double>(k, {&truth, 1});
    CHECK(std::fabs(tb - truth) < 2e-6);           // the true times
    CHECK(ta == doctest::Approx(double(k) / 20));  // the regular ones
    CHECK(std::fabs(double(a.at(100, 40)) / 257 - double(b.at(100, 40))) <
          25);  // noise of both and the coding
  }
  CHECK(k == 24);
  CHECK(std::fabs(truth - 23 / 20.0) > 1e-4);
}

TEST_CASE("the bytes of the video do not depend on the times of checkpoints") {
  const TestFolder f;
  Scenario scene = scenario_from(kScene);
  Session undisturbed = Session::begin(scene, 7, options(f.path / "undisturbed"));
  REQUIRE(undisturbed.run());
  scene.record.checkpoint = 0.1;
  for (const int pause_ms : {3, 8}) {
    const auto dir = f.path / ("pause-" + std::to_string(pause_ms));
    RunOptions o = options(dir);
    bool saved = false;
    o.progress = [&](std::uint64_t done, std::uint64_t total) {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
      saved |= done < total && std::filesystem::exists(dir / "checkpoint");
    };
    Session saving = Session::begin(scene, 7, o);
    REQUIRE(saving.run());
    CHECK(saved);
    CHECK(read_file(dir / "video.mp4") == read_file(f.path / "undisturbed/video.mp4"));
  }
}

TEST_CASE("record.as_seen with sensor = positions changes only the video, not the run") {
  const TestFolder f;
  Document plain = parse_toml(kScene, "test"), seen = plain;
  seen.set("record.as_seen", Json(true), "test");
  const Scenario a = read_scenario(plain, builtin_parts()), b = read_scenario(seen, builtin_parts());
  CHECK(a.hash() == b.hash());
  Session first = Session::begin(a, 7, options(f.path / "a")),
          second = Session::begin(b, 7, options(f.path / "b"));
  REQUIRE(first.run());
  REQUIRE(second.run());
  CHECK(state_hash(first) == state_hash(second));
  CHECK(read_file(f.path / "a/series.csv") == read_file(f.path / "b/series.csv"));
  CHECK(read_file(f.path / "a/video.avi") != read_file(f.path / "b/video.avi"));
}

TEST_CASE("resume: rejected without an unfinished run") {
  const TestFolder f;
  const auto resume = [&](const std::filesystem::path& dir) {
    Session::resume(builtin_parts(), options(dir));
  };
  CHECK_THROWS_WITH_AS(resume(f.path / "none"),
                       (f.path / "none")
                           .string()
                           .append(": directory not found; give a run directory, such as runs/steer-1")
                           .c_str(),
                       Error);
  CHECK_THROWS_WITH_AS(
      resume(f.path),
      f.path.string()
          .append(": is not a run directory: it has no manifest.json; give the directory of a run")
          .c_str(),
      Error);
  Session done = Session::begin(scenario_from(kScene), 1, options(f.path / "done"));
  done.run();
  done.complete();
  CHECK_THROWS_WITH_AS(
      resume(f.path / "done"),
      (f.path / "done").string().append(": the run is complete; there is nothing to resume").c_str(), Error);
}

TEST_CASE("an existing run is not overwritten without force; force keeps files that do not belong to a run") {
  const TestFolder f;
  Session::begin(scenario_from(kScene), 1, options(f.path / "run")).run();
  CHECK_THROWS_AS(Session::begin(scenario_from(kScene), 1, options(f.path / "run")), Error);
  write_file(f.path / "run/notes.txt", "mine");
  RunOptions o = options(f.path / "run");
  o.force = true;
  Session::begin(scenario_from(kScene), 1, o).run();
  CHECK(read_file(f.path / "run/notes.txt") == "mine");
}

TEST_CASE("R6: a corrupt checkpoint is rejected, for an error in any byte") {
  const TestFolder f;
  Archive a;
  std::vector<double> numbers(50, 1.25);
  a& numbers;
  write_checkpoint(f.path / "c", "scene", a);
  const std::string good = read_file(f.path / "c");
  CHECK_NOTHROW(read_checkpoint(f.path / "c", "scene"));
  CHECK_THROWS_AS(read_checkpoint(f.path / "c", "other scene"), Error);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ 0x10);
    write_file(f.path / "c", bad);
    CHECK_THROWS_AS(read_checkpoint(f.path / "c", "scene"), Error);
  }
  for (std::size_t n = 0; n < good.size(); n += 7) {
    write_file(f.path / "c", good.substr(0, n));
    CHECK_THROWS_AS(read_checkpoint(f.path / "c", "scene"), Error);
  }
}
