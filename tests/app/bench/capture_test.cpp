// Frames that `faba rig capture` keeps, with a test camera.
#include <doctest/doctest.h>

#include <fstream>

#include "app/bench/capture.h"
#include "core/error.h"
#include "core/file.h"
#include "core/monotonic.h"
#include "core/table.h"
#include "tests/temporary_folder.h"
#include "vision/files/picture.h"
#include "vision/files/picture_metadata.h"
#include "vision/files/tiff/tiff_stack.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

// A camera at 10 Hz (0.0 s, 0.1 s ...) that delivers frames without waiting. Frame k (from 1) has grey value
// 5 k. Frames 7 and 8 are dropped.
class TestCamera final : public Camera {
 public:
  explicit TestCamera(int frames, bool fails = false) : frames_(frames), fails_(fails) {}
  bool read(CameraFrame& out) override {
    if (next_ > frames_) {
      if (fails_) throw Error(Errc::device, "camera", "failed");
      return false;
    }
    out.number = std::uint64_t(next_);
    out.t = 100 + 0.1 * (next_ - 1);
    out.image = std::make_shared<Gray8>(20, 14, std::uint8_t(5 * next_));
    next_ = next_ == 6 ? 9 : next_ + 1;
    return true;
  }
  void interrupt() noexcept override {}
  int width() const override { return 20; }
  int height() const override { return 14; }
  double rate() const override { return 10; }
  bool waits() const override { return true; }
  std::uint64_t corrupt() const override { return 3; }

 private:
  int frames_, next_ = 1;
  bool fails_;
};

// Camera frame numbers of the kept frames.
std::vector<double> numbers(const std::filesystem::path& times) {
  const Table t = read_table(times, LastLine::keep);
  const auto column = t.column("camera_frame");
  return {column.begin(), column.end()};
}

CaptureJob into(const std::filesystem::path& out, const std::string& format) {
  CaptureJob job;
  job.out = out;
  job.format = format;
  return job;
}

}  // namespace

TEST_CASE("kept frames with one_of, every, frames and time, streaming and buffered") {
  const test::TemporaryFolder f("capture");
  int k = 0;
  const auto kept = [&](auto&& change) {
    std::vector<double> streamed;
    for (const bool buffered : {false, true}) {
      CaptureJob job = into(f.path() / std::to_string(k++), "pgm");
      job.buffered = buffered;
      change(job);
      const Captured c = capture(std::make_shared<TestCamera>(20), job);
      const auto now = numbers(job.out / "times.csv");
      CHECK(c.kept == now.size());
      CHECK(c.corrupt == 3);
      if (buffered) CHECK(now == streamed);
      streamed = now;
    }
    return streamed;
  };
  CHECK(kept([](CaptureJob& j) { j.one_of = 4; }) ==
        std::vector<double>{1, 5, 11, 15, 19});  // counted without the dropped frames
  CHECK(kept([](CaptureJob& j) { j.frames = 7; }) == std::vector<double>{1, 2, 3, 4, 5, 6, 9});
  CHECK(kept([](CaptureJob& j) {
          j.frames = 7;
          j.one_of = 3;
        }) == std::vector<double>{1, 4, 9});
  CHECK(kept([](CaptureJob& j) { j.time = 0.45; }) == std::vector<double>{1, 2, 3, 4, 5});
  // Due at 0, 0.3, 0.6 (dropped; the next frame is used), 0.9 ...
  CHECK(kept([](CaptureJob& j) { j.every = 0.3; }) == std::vector<double>{1, 4, 9, 10, 13, 16, 19});
}

TEST_CASE("pictures of every format and lossless videos have the grey values of the camera") {
  const test::TemporaryFolder f("capture");
  for (const std::string format : {"png", "pgm", "ppm", "tiff"}) {
    INFO(format);
    const auto folder = f.path() / format;
    const Captured c = capture(std::make_shared<TestCamera>(20), into(folder, format));
    CHECK(c.taken == 18);
    CHECK(c.dropped == 2);
    CHECK(c.duration == doctest::Approx(1.9));
    const Picture p = read_picture(folder / ("frame-000005." + format));
    CHECK(p.grey.width == 20);
    CHECK(p.grey.height == 14);
    CHECK(p.grey.at(3, 4) == 30);
    VideoReader all(folder, 10);
    CHECK(all.frames_in_header() == 18);
  }
  capture(std::make_shared<TestCamera>(20), into(f.path() / "film.avi", "avi"));
  VideoReader video(f.path() / "film.avi");
  GrayF frame;
  double t = 0;
  for (int i = 0; i < 6; ++i) REQUIRE(video.read(frame, t));
  CHECK(frame.at(3, 4) == 30);
  CHECK(numbers(f.path() / "film.avi.csv").size() == 18);
}

TEST_CASE("a camera failure is reported; earlier frames are readable in a file marked as incomplete") {
  const test::TemporaryFolder f("capture");
  for (const bool buffered : {false, true}) {
    CaptureJob job = into(f.path() / (buffered ? "b.avi" : "a.avi"), "avi");
    job.buffered = buffered;
    CHECK_THROWS_WITH_AS(capture(std::make_shared<TestCamera>(6, true), job),
                         doctest::Contains("failed; 6 recorded frames are in"), Error);
    CHECK_FALSE(std::filesystem::exists(job.out));
    VideoReader video(job.out.string() + ".part");
    GrayF frame;
    double t = 0;
    int frames = 0;
    while (video.read(frame, t)) ++frames;
    CHECK(frames == 6);
    CHECK(numbers(job.out.string() + ".csv").size() == 6);
  }
}

TEST_CASE("a folder of pictures is marked incomplete until the capture is complete") {
  const test::TemporaryFolder f("capture");
  const auto failed = f.path() / "failed", complete = f.path() / "complete", empty = f.path() / "empty";
  CHECK_THROWS_WITH_AS(capture(std::make_shared<TestCamera>(6, true), into(failed, "pgm")),
                       doctest::Contains("failed; 6 recorded frames are in"), Error);
  CHECK(read_file(failed / "incomplete").find("This capture is not complete.") != std::string::npos);
  CHECK(numbers(failed / "times.csv").size() == 6);
  CHECK(VideoReader(failed, 10).frames_in_header() == 6);

  capture(std::make_shared<TestCamera>(6), into(complete, "pgm"));
  CHECK_FALSE(std::filesystem::exists(complete / "incomplete"));
  // Without pictures the folder stays empty, and the next capture can use it.
  CHECK_THROWS_AS(capture(std::make_shared<TestCamera>(0, true), into(empty, "pgm")), Error);
  CHECK(std::filesystem::is_empty(empty));
  capture(std::make_shared<TestCamera>(6), into(empty, "pgm"));
}

TEST_CASE("a picture that cannot be written is named, and the folder stays marked incomplete") {
  const test::TemporaryFolder f("capture");
  const auto folder = f.path() / "pictures";
  CaptureJob job = into(folder, "pgm");
  job.frames = 6;
  // A folder takes the temporary name of the third picture.
  job.progress = [&](std::uint64_t done, std::uint64_t) {
    if (done == 1) std::filesystem::create_directories(folder / "frame-000002.pgm.tmp/x");
  };
  try {
    capture(std::make_shared<TestCamera>(6), job);
    FAIL("nothing was thrown");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::internal);
    CHECK(e.where() == (folder / "frame-000002.pgm").string());
    CHECK(e.reason().find("2 recorded frames are in") != std::string::npos);
  }
  CHECK(std::filesystem::exists(folder / "incomplete"));
  CHECK(numbers(folder / "times.csv").size() == 2);
}

TEST_CASE("existing files are not overwritten") {
  const test::TemporaryFolder f("capture");
  const auto video = f.path() / "a.avi", folder = f.path() / "pictures";
  std::ofstream(video) << "mine";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "mine") << "mine";
  CHECK_THROWS_AS(capture(std::make_shared<TestCamera>(3), into(video, "avi")), Error);
  CHECK_THROWS_AS(capture(std::make_shared<TestCamera>(3), into(folder, "pgm")), Error);
  CHECK(std::filesystem::file_size(video) == 4);
}

TEST_CASE("a TIFF stack of a capture has its frames, scale and interval; dropped frames do not change them") {
  const test::TemporaryFolder f("capture-stack");
  for (const char* name : {"look.ome.tif", "look.tif"}) {
    CaptureJob job = into(f.path() / name, "tif");
    job.um_per_px = 0.35;
    CHECK(capture(std::make_shared<TestCamera>(20), job).kept == 18);
    TiffStack stack(job.out);
    CHECK(stack.pages() == 18);
    CHECK(*stack.metadata().um_per_px == doctest::Approx(0.35).epsilon(1e-6));
    CHECK(stack.fps() == doctest::Approx(10).epsilon(1e-6));
    GrayF page;
    for (const int k : {1, 2, 3, 4, 5, 6, 9}) {
      REQUIRE(stack.read(page));
      CHECK(page.px[0] == float(5 * k));
    }
    CHECK_FALSE(std::filesystem::exists(job.out.string() + ".part"));
    CHECK(numbers(job.out.string() + ".csv").size() == 18);
    CHECK_THROWS_AS(capture(std::make_shared<TestCamera>(20), job), Error);  // exists
  }
  CaptureJob failing = into(f.path() / "failing.tif", "tif");
  CHECK_THROWS_AS(capture(std::make_shared<TestCamera>(10, true), failing), Error);
  CHECK_FALSE(std::filesystem::exists(failing.out));
  CHECK(VideoReader(failing.out.string() + ".part").width() == 20);  // the recorded frames are readable
  CaptureJob none = into(f.path() / "none.tif", "tif");
  CHECK(capture(std::make_shared<TestCamera>(0), none).kept == 0);
  CHECK_FALSE(std::filesystem::exists(none.out));
}

TEST_CASE("the frame rate of a captured folder is that of its table of times") {
  const test::TemporaryFolder f("capture-rate");
  capture(std::make_shared<TestCamera>(20), into(f.path() / "p", "png"));
  CHECK(picture_metadata(f.path() / "p").fps == doctest::Approx(10).epsilon(1e-6));
  CHECK(VideoReader(f.path() / "p").fps() == doctest::Approx(10).epsilon(1e-6));
  CHECK(VideoReader(f.path() / "p", 3).fps() == 3);
  write_file(f.path() / "p/times.csv", "some,other,table\n1,two,3\n");
  CHECK(picture_metadata(f.path() / "p").fps == 0);
}
