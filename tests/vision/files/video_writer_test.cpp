#include "vision/files/video_writer.h"

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <functional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "tests/vision/media.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

constexpr int kWidth = 94, kHeight = 62;

struct Frames {
  std::vector<GrayF> grey;
  std::vector<double> t_s;
};

Frames read_all(const std::filesystem::path& path) {
  VideoReader reader(path);
  Frames frames;
  GrayF grey;
  double t_s = 0;
  while (reader.read(grey, t_s)) {
    frames.grey.push_back(grey);
    frames.t_s.push_back(t_s);
  }
  CHECK_FALSE(reader.truncated());
  CHECK(reader.damaged_frames() == 0);
  return frames;
}

// Peak signal-to-noise ratio in dB of grey frames against the pictures that were written (r = g = b).
double psnr(const GrayF& got, const RgbImage& wanted) {
  double sum = 0;
  for (int row = 0; row < wanted.height; ++row) {
    for (int col = 0; col < wanted.width; ++col) {
      const double difference = double{got.at(col, row)} - wanted.at(col, row).r;
      sum += difference * difference;
    }
  }
  return 10 * std::log10(255.0 * 255.0 * double(wanted.px.size()) / sum);
}

// Writes frames `first` to `last` - 1 and syncs after frame `sync_after`; returns the byte count of the sync.
std::uint64_t record(VideoWriter& writer, int first, int last, int sync_after = -1) {
  std::uint64_t safe = 0;
  for (int frame = first; frame < last; ++frame) {
    writer.write(media::scene(kWidth, kHeight, frame, true));
    if (frame + 1 == sync_after) safe = writer.sync();
  }
  return safe;
}

Error refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error");
  return {Errc::usage, "", ""};
}

// Simulates a full disk: limits the file size of this process to `bytes` during its lifetime.
class FullDisk {
 public:
  explicit FullDisk(std::uint64_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

}  // namespace

TEST_CASE("lossless_avi returns every pixel, at odd sizes and in colour") {
  const media::ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{94, 62}, std::pair{37, 23}, std::pair{1, 3}}) {
    VideoWriter writer(folder / "v.part", VideoFormat::lossless_avi, width, height, 15);
    for (int frame = 0; frame < 7; ++frame) writer.write(media::scene(width, height, frame, true));
    writer.finish(folder / "v.avi");
    CHECK_FALSE(std::filesystem::exists(folder / "v.part"));
    const Frames frames = read_all(folder / "v.avi");
    REQUIRE(frames.grey.size() == 7);
    for (int frame = 0; frame < 7; ++frame) {
      const GrayF& got = frames.grey[std::size_t(frame)];
      const RgbImage wanted = media::scene(width, height, frame, true);
      REQUIRE(got.width == width);
      REQUIRE(got.height == height);
      int wrong = 0;
      for (std::size_t i = 0; i < wanted.px.size(); ++i) {
        const auto [r, g, b] = wanted.px[i];
        const float expected =
            r == g && g == b ? float(r) : 0.2989F * float(r) + 0.5870F * float(g) + 0.1140F * float(b);
        wrong += got.px[i] != expected ? 1 : 0;
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("mp4: after restart() the bytes are those of a new writer") {
  const media::ScratchFolder folder;
  const auto bytes_after = [&](const char* name, int first, bool restart) {
    VideoWriter writer(folder / name, VideoFormat::mp4, kWidth, kHeight, 15);
    record(writer, first, 10);
    const auto before = std::filesystem::file_size(folder / name);
    if (restart) writer.restart();
    record(writer, 10, 14);
    return read_file(folder / name).substr(before);
  };
  const std::string alone = bytes_after("new.part", 10, false);
  CHECK(bytes_after("restarted.part", 0, true) == alone);
  CHECK(bytes_after("continued.part", 0, false) != alone);
}

TEST_CASE("mp4: a second has at least one key frame, which repeats the parameters of the video") {
  const media::ScratchFolder folder;
  const std::vector<std::pair<double, int>> key_frames_of_16{{0.5, 16}, {1.5, 16}, {15, 2}, {30, 1}};
  for (const auto& [rate, expected] : key_frames_of_16) {
    VideoWriter writer(folder / "v.part", VideoFormat::mp4, kWidth, kHeight, rate);
    record(writer, 0, 16);
    const std::string bytes = read_file(folder / "v.part");
    int parameters = 0;
    const std::string start("\0\0\1\x67", 4);
    for (auto at = bytes.find(start); at != bytes.npos; at = bytes.find(start, at + 1)) ++parameters;
    CHECK_MESSAGE(parameters == expected, rate);
  }
}

TEST_CASE("mp4: a large file, whose index is not moved to the start, has all frames") {
  const media::ScratchFolder folder;
  constexpr int kSide = 2048, kCount = 12;
  RgbImage noise(kSide, kSide);
  std::uint32_t state = 1;
  for (Rgb& p : noise.px) {
    state = state * 1664525u + 1013904223u;
    const auto grey = std::uint8_t(state >> 24);
    p = {grey, grey, grey};
  }
  VideoWriter writer(folder / "v.part", VideoFormat::mp4, kSide, kSide, 1);
  for (int frame = 0; frame < kCount; ++frame) writer.write(noise);
  writer.finish(folder / "v.mp4");
  REQUIRE(std::filesystem::file_size(folder / "v.mp4") > 32u << 20);
  const Frames frames = read_all(folder / "v.mp4");
  REQUIRE(frames.grey.size() == kCount);
  CHECK(frames.t_s.back() == doctest::Approx(kCount - 1));
  // Two independent pictures of uniform noise have 20 lg(sqrt(6)) = 7.8 dB; here half of their difference at
  // most.
  CHECK(psnr(frames.grey.back(), noise) > 13.8);
}

TEST_CASE("mp4 preserves frames, times and grey values") {
  // Crf 20 quantises luma with steps of 0.625 * 2^(q/6) at q = 20, 3 more in predicted frames and up to 3
  // more in textured areas: at most 12.6 at q = 26. Uniform within a step: rms 12.6 / sqrt(12) = 3.6, 37 dB.
  constexpr double kLeastPsnr = 37;
  const media::ScratchFolder folder;
  VideoWriter writer(folder / "v.part", VideoFormat::mp4, kWidth, kHeight, 15);
  for (int frame = 0; frame < 40; ++frame) writer.write(media::scene(kWidth, kHeight, frame));
  writer.finish(folder / "v.mp4");
  CHECK_FALSE(std::filesystem::exists(folder / "v.part"));
  VideoReader reader(folder / "v.mp4");
  CHECK(reader.width() == kWidth);
  CHECK(reader.height() == kHeight);
  CHECK(reader.bits() == 8);
  CHECK(reader.frames_in_header() == 40);
  CHECK(reader.fps() == 15);
  const Frames frames = read_all(folder / "v.mp4");
  REQUIRE(frames.grey.size() == 40);
  double worst = 100;
  for (int frame = 0; frame < 40; ++frame) {
    worst = std::min(worst, psnr(frames.grey[std::size_t(frame)], media::scene(kWidth, kHeight, frame)));
  }
  CHECK(worst >= kLeastPsnr);
  MESSAGE("mp4: worst frame ", worst, " dB");
}

TEST_CASE("mp4: a uniform grey keeps its value, including black and white") {
  // The step at q = 23 is 8.9, but a uniform picture has one coefficient per block and prediction corrects
  // it: half a grey level for the integer rounding of the decoder, half for that of the last correction.
  const media::ScratchFolder folder;
  for (const int level : {0, 1, 16, 60, 128, 168, 200, 235, 254, 255}) {
    const auto v = static_cast<std::uint8_t>(level);
    VideoWriter writer(folder / "v.part", VideoFormat::mp4, 64, 48, 25);
    for (int frame = 0; frame < 5; ++frame) writer.write(RgbImage(64, 48, {v, v, v}));
    writer.finish(folder / "v.mp4");
    const Frames frames = read_all(folder / "v.mp4");
    double sum = 0;
    for (const float value : frames.grey.back().px) sum += double{value};
    CHECK(std::abs(sum / (64 * 48) - level) <= 1);
  }
}

TEST_CASE("mp4 of odd size repeats the last column and row") {
  const media::ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{37, 23}, std::pair{1, 3}}) {
    VideoWriter writer(folder / "v.part", VideoFormat::mp4, width, height, 25);
    for (int frame = 0; frame < 3; ++frame) writer.write(media::scene(width, height, frame));
    writer.finish(folder / "v.mp4");
    const Frames frames = read_all(folder / "v.mp4");
    REQUIRE(frames.grey.size() == 3);
    CHECK(frames.grey[0].width == width + 1);
    CHECK(frames.grey[0].height == height + 1);
    CHECK(psnr(frames.grey[2], media::scene(width, height, 2)) >= 37);  // as above
  }
}

TEST_CASE("frame rates are stored as fractions") {
  CHECK(frame_rate_near(15).numerator == 15);
  CHECK(frame_rate_near(13.65).numerator == 273);
  CHECK(frame_rate_near(13.65).denominator == 20);
  CHECK(frame_rate_near(59.94).numerator == 2997);
  CHECK(frame_rate_near(30000.0 / 1001).denominator == 1001);
  CHECK_THROWS_AS(frame_rate_near(0), Error);
  CHECK_THROWS_AS(frame_rate_near(std::nan("")), Error);
  const media::ScratchFolder folder;
  for (const double fps : {15.0, 13.65, 59.94, 0.5, 1000.0}) {
    for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
      CAPTURE(fps);
      CAPTURE(int(format));
      VideoWriter writer(folder / "v.part", format, 32, 18, fps);
      for (int frame = 0; frame < 31; ++frame) writer.write(media::scene(32, 18, frame));
      writer.finish(folder / "v");
      const Frames frames = read_all(folder / "v");
      REQUIRE(frames.t_s.size() == 31);
      // Frame times are integer multiples of the time base of both containers: only double rounding remains.
      for (int frame = 0; frame < 31; ++frame)
        CHECK(std::abs(frames.t_s[std::size_t(frame)] - frame / fps) < 1e-12 * frame / fps + 1e-15);
      CHECK(VideoReader(folder / "v").fps() == doctest::Approx(fps).epsilon(1e-12));
    }
  }
}

TEST_CASE("an interrupted and resumed recording gives the same file as an uninterrupted one") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    CAPTURE(int(format));
    VideoWriter uninterrupted(folder / "uninterrupted.part", format, kWidth, kHeight, 13.65);
    record(uninterrupted, 0, 20, 12);
    uninterrupted.finish(folder / "uninterrupted");

    std::uint64_t safe = 0;
    {
      VideoWriter interrupted(folder / "interrupted.part", format, kWidth, kHeight, 13.65);
      safe = record(interrupted, 0, 17, 12);  // five frames after the last sync are lost in the crash
    }
    CHECK(std::filesystem::file_size(folder / "interrupted.part") > safe);
    std::filesystem::resize_file(folder / "interrupted.part",
                                 std::filesystem::file_size(folder / "interrupted.part") - 3);
    VideoWriter resumed(folder / "interrupted.part", format, kWidth, kHeight, 13.65, safe);
    record(resumed, 12, 20);
    resumed.finish(folder / "resumed");

    CHECK(read_all(folder / "resumed").grey.size() == 20);
    CHECK(media::read_bytes(folder / "resumed") == media::read_bytes(folder / "uninterrupted"));
  }
}

TEST_CASE("a finished recording can be resumed when its part was kept") {
  const media::ScratchFolder folder;
  VideoWriter uninterrupted(folder / "uninterrupted.part", VideoFormat::mp4, kWidth, kHeight, 15);
  record(uninterrupted, 0, 9, 4);
  uninterrupted.finish(folder / "uninterrupted");

  VideoWriter first(folder / "v.part", VideoFormat::mp4, kWidth, kHeight, 15);
  const std::uint64_t safe = record(first, 0, 4, 4);
  first.finish(folder / "v", true);
  CHECK(read_all(folder / "v").grey.size() == 4);
  VideoWriter second(folder / "v.part", VideoFormat::mp4, kWidth, kHeight, 15, safe);
  record(second, 4, 9);
  second.finish(folder / "v");
  CHECK(media::read_bytes(folder / "v") == media::read_bytes(folder / "uninterrupted"));
}

TEST_CASE("the same frames and syncs give the same bytes, and no sync loses a frame") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    for (const char* name : {"a", "b"}) {
      VideoWriter writer(folder / "v.part", format, kWidth, kHeight, 15);
      CHECK(writer.sync() == 0);
      for (int frame = 0; frame < 9; ++frame) {
        writer.write(media::scene(kWidth, kHeight, frame));
        CHECK(writer.sync() == std::filesystem::file_size(folder / "v.part"));
        CHECK(writer.sync() == std::filesystem::file_size(folder / "v.part"));
      }
      writer.finish(folder / name);
      CHECK(read_all(folder / name).grey.size() == 9);
    }
    CHECK(media::read_bytes(folder / "a") == media::read_bytes(folder / "b"));
  }
}

TEST_CASE("the growing file is readable after every frame") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    CAPTURE(int(format));
    VideoWriter writer(folder / "v.part", format, kWidth, kHeight, 15);
    for (int frame = 0; frame < 20; ++frame) {
      writer.write(media::scene(kWidth, kHeight, frame));
      const Frames so_far = read_all(folder / "v.part");
      REQUIRE(int(so_far.grey.size()) == frame + 1);
      CHECK(psnr(so_far.grey.back(), media::scene(kWidth, kHeight, frame)) >= 37);  // as above
    }
  }
}

TEST_CASE("a recording cannot be resumed beyond its end") {
  const media::ScratchFolder folder;
  media::write_bytes(folder / "v.part", "0123456789");
  const auto resume = [&](const char* name, std::uint64_t at) {
    return refusal([&] { VideoWriter(folder / name, VideoFormat::mp4, 32, 18, 15, at); });
  };
  CHECK(resume("v.part", 11).code() == Errc::input);
  CHECK(resume("v.part", 11).where() == (folder / "v.part").string());
  CHECK(std::filesystem::file_size(folder / "v.part") == 10);
  CHECK(resume("missing.part", 5).code() == Errc::input);
}

TEST_CASE("a full disk and paths that cannot be written") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    VideoWriter writer("/dev/full", format, kWidth, kHeight, 15);
    const Error full = refusal([&] { writer.write(media::scene(kWidth, kHeight, 0)); });
    CHECK(full.code() == Errc::internal);
    CHECK(full.where() == "/dev/full");
    CHECK(std::string(full.what()).find("No space left") != std::string::npos);
  }
  const auto nowhere = folder / "no folder/v.part";
  CHECK(refusal([&] { VideoWriter(nowhere, VideoFormat::mp4, 32, 18, 15); }).where() == nowhere.string());
  CHECK_THROWS_AS(VideoWriter(folder / "v.part", VideoFormat::mp4, 0, 18, 15), Error);
  CHECK_THROWS_AS(VideoWriter(folder / "v.part", VideoFormat::mp4, 32, 18, -1), Error);
  VideoWriter writer(folder / "v.part", VideoFormat::mp4, 32, 18, 15);
  CHECK_THROWS_AS(writer.write(RgbImage(18, 32)), Error);
  CHECK(refusal([&] { writer.finish(folder / "v.mp4"); }).code() == Errc::internal);  // no frame
}

TEST_CASE(
    "when the disk fills up during recording, the recorded frames stay complete and recording can resume") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    CAPTURE(int(format));
    VideoWriter writer(folder / "v.part", format, kWidth, kHeight, 15);
    record(writer, 0, 5);
    const auto length = std::filesystem::file_size(folder / "v.part");
    {
      const FullDisk full(length + 10);
      CHECK(refusal([&] { record(writer, 5, 6); }).code() == Errc::internal);
    }
    CHECK(std::filesystem::file_size(folder / "v.part") == length);
    record(writer, 5, 8);
    {
      const FullDisk full(length / 2);
      const Error error = refusal([&] { writer.finish(folder / "v"); });
      CHECK(error.code() == Errc::internal);
      CHECK(error.where() == (folder / "v").string());
    }
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);  // only `part`
    CHECK(refusal([&] { writer.finish(folder / "no folder/v"); }).code() == Errc::internal);
    writer.finish(folder / "v");
    CHECK(read_all(folder / "v").grey.size() == 8);
    std::filesystem::remove(folder / "v");
  }
}

TEST_CASE("colours are read back: exactly from lossless_avi, up to coding noise from mp4") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::lossless_avi, VideoFormat::mp4}) {
    VideoWriter writer(folder / "part", format, 120, 84, 15);
    for (int k = 0; k < 3; ++k) writer.write(media::scene(120, 84, k, true));
    writer.finish(folder / "film");
    VideoReader reader(folder / "film");
    RgbImage got;
    double t_s = 0, off = 0;
    for (int k = 0; k < 3; ++k) {
      REQUIRE(reader.read_colours(got, t_s));
      CHECK(t_s == doctest::Approx(k / 15.0));
      const RgbImage wanted = media::scene(120, 84, k, true);
      REQUIRE(got.px.size() == wanted.px.size());
      if (format == VideoFormat::lossless_avi) CHECK(got.px == wanted.px);
      for (std::size_t i = 0; i < got.px.size(); ++i)
        off += std::abs(got.px[i].r - wanted.px[i].r) + std::abs(got.px[i].g - wanted.px[i].g) +
               std::abs(got.px[i].b - wanted.px[i].b);
    }
    // Chroma of mp4 has half resolution; a wrong matrix or range would give errors of tens of grey levels.
    CHECK(off / (3.0 * 3 * 120 * 84) < 3);
    CHECK_FALSE(reader.read_colours(got, t_s));
  }
}

TEST_CASE("grey frames give the same mp4 as colour frames of the same greys, including odd sizes") {
  const media::ScratchFolder folder;
  VideoWriter colour(folder / "c.part", VideoFormat::mp4, 121, 83, 15);
  VideoWriter grey(folder / "g.part", VideoFormat::mp4, 121, 83, 15, 0, VideoPixels::grey8);
  for (int k = 0; k < 5; ++k) {
    const RgbImage picture = media::scene(121, 83, k);
    Gray8 same(121, 83);
    for (std::size_t i = 0; i < same.px.size(); ++i) same.px[i] = picture.px[i].r;
    colour.write(picture);
    grey.write(same);
    CHECK_THROWS_AS(grey.write(picture), Error);
  }
  colour.finish(folder / "c.mp4");
  grey.finish(folder / "g.mp4");
  CHECK(media::read_bytes(folder / "c.mp4") == media::read_bytes(folder / "g.mp4"));
}

TEST_CASE("grey frames of 8 and 16 bits round-trip exactly in the lossless format") {
  const media::ScratchFolder folder;
  Gray8 low(33, 21);
  Image<std::uint16_t> high(33, 21);
  for (std::size_t i = 0; i < low.px.size(); ++i) low.px[i] = std::uint8_t(i * 7);
  for (std::size_t i = 0; i < high.px.size(); ++i) high.px[i] = std::uint16_t(i * 977);
  VideoWriter a(folder / "a.part", VideoFormat::lossless_avi, 33, 21, 15, 0, VideoPixels::grey8);
  VideoWriter b(folder / "b.part", VideoFormat::lossless_avi, 33, 21, 15, 0, VideoPixels::grey16);
  for (int k = 0; k < 3; ++k) a.write(low);
  for (int k = 0; k < 3; ++k) b.write(high);
  a.finish(folder / "a.avi");
  b.finish(folder / "b.avi");
  VideoReader ra(folder / "a.avi"), rb(folder / "b.avi");
  CHECK(ra.bits() == 8);
  CHECK(rb.bits() == 16);
  GrayF frame;
  double t = 0;
  REQUIRE(ra.read(frame, t));
  for (std::size_t i = 0; i < low.px.size(); ++i) REQUIRE(frame.px[i] == float(low.px[i]));
  REQUIRE(rb.read(frame, t));
  for (std::size_t i = 0; i < high.px.size(); ++i) REQUIRE(frame.px[i] == float(high.px[i]));
  CHECK_THROWS_AS(VideoWriter(folder / "c.part", VideoFormat::mp4, 33, 21, 15, 0, VideoPixels::grey16),
                  Error);
}
