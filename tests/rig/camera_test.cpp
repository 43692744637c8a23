// Cameras and the thread that reads them: a video played as a camera, and a camera controlled by the test.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "app/scenario/parts.h"
#include "core/monotonic.h"
#include "rig/bench/bench_rig.h"
#include "tests/rendered_video.h"
#include "tests/temporary_folder.h"
#include "vision/files/video_writer.h"

using namespace faba;

namespace {

// A camera that gives frames on command of the test.
struct HandCamera final : Camera {
  std::atomic<std::uint64_t> allowed = 0;  // number of frames that may be taken
  std::atomic<bool> over = false, fails = false;
  std::atomic<std::uint64_t> number = 0;
  std::atomic<double> began = monotonic_now();

  bool read(CameraFrame& out) override {
    while (number >= allowed && !over) {
      if (fails) throw Error(Errc::device, "hand", "unplugged");
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    if (over) return false;
    out.number = ++number;
    out.t = began + double(number);
    out.image = std::make_shared<Gray8>(8, 6, std::uint8_t(number));
    return true;
  }
  void interrupt() noexcept override { over = true; }
  int width() const override { return 8; }
  int height() const override { return 6; }
  double rate() const override { return 1; }
};

// 12 frames at 20 Hz; frame k has grey value 10 k.
std::filesystem::path test_video(const std::filesystem::path& folder) {
  VideoWriter w(folder / "part", VideoFormat::lossless_avi, 32, 24, 20, 0, VideoPixels::grey8);
  for (int k = 0; k < 12; ++k) w.write(Gray8(32, 24, std::uint8_t(10 * k)));
  w.finish(folder / "video.avi");
  return folder / "video.avi";
}

std::shared_ptr<Camera> playback(const std::filesystem::path& file, bool fast) {
  Document d;
  d.root = {{"camera", {{"type", "playback"}, {"file", file.string()}, {"fast", fast}}}};
  return builtin_parts().camera.resolve(Node(d).child("camera")).make({});
}

}  // namespace

TEST_CASE("a late consumer gets the newest frame, and dropped frames are counted") {
  auto camera = std::make_shared<HandCamera>();
  CameraFeed feed(camera, CameraFeed::Keep::newest);
  CameraFrame f;
  CHECK(feed.next(f, monotonic_now() + 0.01) == CameraFeed::Got::nothing);
  camera->allowed = 1;
  REQUIRE(feed.next(f, monotonic_now() + 5) == CameraFeed::Got::frame);
  CHECK(f.number == 1);
  camera->allowed = 5;
  while (camera->number < 5) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  REQUIRE(feed.next(f, monotonic_now() + 5) == CameraFeed::Got::frame);
  CHECK(f.number == 5);
  CHECK(f.image->px[0] == 5);
  CHECK(feed.taken() == 2);
  CHECK(feed.dropped() == 3);
}

TEST_CASE("Keep::all queues all frames") {
  auto camera = std::make_shared<HandCamera>();
  CameraFeed feed(camera, CameraFeed::Keep::all);
  camera->allowed = 40;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CameraFrame f;
  for (std::uint64_t k = 1; k <= 40; ++k) {
    REQUIRE(feed.next(f, monotonic_now() + 5) == CameraFeed::Got::frame);
    CHECK(f.number == k);
  }
  CHECK(feed.dropped() == 0);
}

TEST_CASE("a run starts with a frame taken after its start, and does not count frames dropped before") {
  auto camera = std::make_shared<HandCamera>();
  BenchRig rig(camera, nullptr, {.camera_timeout = 5});
  camera->allowed = 4;
  while (camera->number < 4) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  rig.begin();
  Observation o;
  std::jthread later([&] {
    const double now = camera->began;
    camera->began = now - 1000;  // a frame taken before the start
    camera->allowed = 5;
    while (camera->number < 5) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    camera->began = now;
    camera->allowed = 6;
  });
  REQUIRE(rig.read(o));
  CHECK(o.frame == 0);
  CHECK(o.t == 0);
  CHECK(o.image->px[0] == 6);
  CHECK(rig.dropped() == 0);
}

TEST_CASE("old frames are reported as an error") {
  auto camera = std::make_shared<HandCamera>();
  camera->began -= 1000;
  BenchRig rig(camera, nullptr, {.camera_timeout = 0.2});
  rig.begin();
  camera->allowed = 3;
  Observation o;
  CHECK_THROWS_WITH_AS(rig.read(o), doctest::Contains("frames are 99"), Error);
}

TEST_CASE("the error of a camera reaches the reader") {
  auto camera = std::make_shared<HandCamera>();
  BenchRig rig(camera, nullptr, {.camera_timeout = 5});
  camera->allowed = 1;
  Observation o;
  REQUIRE(rig.read(o));
  camera->fails = true;
  CHECK_THROWS_WITH_AS(rig.read(o), "hand: unplugged", Error);
}

TEST_CASE("a camera that hangs does not block its reader") {
  auto camera = std::make_shared<HandCamera>();
  BenchRig rig(camera, nullptr, {.camera_timeout = 0.1});
  Observation o;
  CHECK_THROWS_AS(rig.read(o), Error);
}

TEST_CASE("a video is played in real time, with the times of the file") {
  const test::TemporaryFolder folder("playback");
  const auto camera = playback(test_video(folder.path()), false);
  CHECK(camera->width() == 32);
  CHECK(camera->rate() == doctest::Approx(20));
  BenchRig rig(camera, nullptr, {});
  Observation o;
  const double began = monotonic_now();
  std::uint64_t frames = 0;
  while (rig.read(o)) {
    CHECK(o.t == doctest::Approx(double(o.frame) / 20));
    CHECK(o.image->px[0] == 10 * o.frame);
    CHECK(o.age >= 0);
    ++frames;
  }
  CHECK(frames + rig.feed().dropped() == 12);
  CHECK(monotonic_now() - began > 11.0 / 20 - 0.01);  // not faster than real time
}

TEST_CASE("fast playback: no frame is dropped, also with a slow reader") {
  const test::TemporaryFolder folder("playback");
  const auto camera = playback(test_video(folder.path()), true);
  BenchRig rig(camera, nullptr, {.camera_timeout = 2, .keep = CameraFeed::Keep::each});
  Observation o;
  for (std::uint64_t k = 0; k < 12; ++k) {
    REQUIRE(rig.read(o));
    CHECK(o.frame == k);
    CHECK(o.t == doctest::Approx(double(k) / 20));
    CHECK(o.age == 0);
    if (k == 3) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  CHECK_FALSE(rig.read(o));
  CHECK(rig.feed().dropped() == 0);
}

TEST_CASE("a missing file and a missing option are errors") {
  const test::TemporaryFolder folder("playback");
  CHECK_THROWS_AS(playback(folder.path() / "none.avi", true), Error);
  Document d;
  d.root = {{"camera", "playback"}};
  CHECK_THROWS_AS(builtin_parts().camera.resolve(Node(d).child("camera")), Error);
}
