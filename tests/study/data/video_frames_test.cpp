#include "study/data/video_frames.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/vision/media.h"
#include "tests/vision/raw_files.h"
#include "vision/files/picture.h"
#include "vision/files/video_writer.h"

using namespace faba;

namespace {

constexpr int kWidth = 94, kHeight = 62, kFrames = 47;

// 10 frames per second; mp4 has a key frame each second.
std::filesystem::path record(const std::filesystem::path& name, VideoFormat format,
                             const std::function<double(long long)>& time_s = {}) {
  VideoWriter writer(name.string() + ".part", format, kWidth, kHeight, 10);
  for (int frame = 0; frame < kFrames; ++frame) writer.write(media::scene(kWidth, kHeight, frame));
  writer.finish(name, false, time_s);
  return name;
}

std::filesystem::path sequence(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (int k = 0; k < 12; ++k)
    write_png(folder / fmt::format("p{:02}.png", k), media::scene(kWidth, kHeight, k));
  return folder;
}

std::filesystem::path stack(const std::filesystem::path& name, int pages) {
  std::vector<media::TiffPage> all;
  for (int k = 0; k < pages; ++k) {
    media::TiffPage page{.width = 40, .height = 30};
    for (int i = 0; i < 1200; ++i) page.pixels += char(10 * k + i % 7);
    all.push_back(page);
  }
  media::write_bytes(name, media::tiff_file(all));
  return name;
}

std::vector<VideoFrame> in_order(const std::filesystem::path& video) {
  VideoReader reader(video);
  std::vector<VideoFrame> all;
  VideoFrame frame;
  while (reader.read(frame.grey, frame.t_s)) {
    frame.index = std::int64_t(all.size());
    all.push_back(frame);
  }
  return all;
}

// Frames forwards, backwards and across the video, compared with those of reading in order.
void check_any_order(const std::filesystem::path& video) {
  INFO(video.string());
  const std::vector<VideoFrame> all = in_order(video);
  REQUIRE(all.size() > 4);
  VideoFrames frames(video);
  const std::size_t n = all.size();
  for (const std::size_t at : {std::size_t{0}, n - 1, n / 2, n / 2 + 1, n / 2 - 1, n - 2, std::size_t{1},
                               n / 3, n - 1, n - 1, std::size_t{0}, n / 4, n / 4 + 3, n / 4 + 1}) {
    INFO("frame ", at);
    const VideoFrameRef found = frames.at(all[at].t_s);
    CHECK(found->t_s == doctest::Approx(all[at].t_s));
    CHECK(found->grey.px == all[at].grey.px);
    const double after = at + 1 < n ? all[at + 1].t_s : all[at].t_s + 1;
    CHECK(frames.at(0.3 * all[at].t_s + 0.7 * after)->grey.px == all[at].grey.px);  // between two frames
    const VideoFrameRef next = frames.next();
    REQUIRE((next != nullptr) == (at + 1 < n));
    if (next) CHECK(next->grey.px == all[at + 1].grey.px);
  }
  CHECK(frames.at(-5)->grey.px == all.front().grey.px);
  CHECK(frames.at(1e6)->grey.px == all.back().grey.px);
  CHECK(frames.last()->grey.px == all.back().grey.px);
  CHECK(frames.damage().empty());
}

}  // namespace

TEST_CASE("frames in any order are those of reading in order") {
  const media::ScratchFolder folder;
  check_any_order(record(folder / "a.mp4", VideoFormat::mp4));
  check_any_order(record(folder / "a.avi", VideoFormat::lossless_avi));
  check_any_order(sequence(folder / "pictures"));
  check_any_order(stack(folder / "stack.tif", 9));
}

TEST_CASE("frames with unequal intervals are found by their time, also after a long gap") {
  const media::ScratchFolder folder;
  const auto time_s = [](long long k) {
    return 0.1 * double(k) + (k >= 20 ? 4.0 : 0.0) + 0.02 * double(k % 3);
  };
  check_any_order(record(folder / "gap.mp4", VideoFormat::mp4, time_s));
}

TEST_CASE("a truncated video has its frames up to the damage, and the damage is reported") {
  const media::ScratchFolder folder;
  const std::string bytes = media::read_bytes(record(folder / "a.avi", VideoFormat::lossless_avi));
  media::write_bytes(folder / "short.avi", bytes.substr(0, bytes.size() / 2));
  const std::vector<VideoFrame> all = in_order(folder / "short.avi");
  REQUIRE(all.size() > 4);
  VideoFrames frames(folder / "short.avi");
  CHECK(frames.at(4.6)->grey.px == all.back().grey.px);
  CHECK(frames.at(0.2)->grey.px == all[2].grey.px);
  CHECK(frames.last()->grey.px == all.back().grey.px);
  CHECK_FALSE(frames.damage().empty());

  const std::string pages = media::read_bytes(stack(folder / "stack.tif", 9));
  media::write_bytes(folder / "short.tif", pages.substr(0, 3 * pages.size() / 5));
  const std::vector<VideoFrame> complete = in_order(folder / "short.tif");
  REQUIRE(complete.size() > 2);
  REQUIRE(complete.size() < 9);
  VideoFrames cut(folder / "short.tif");
  CHECK(cut.at(8)->grey.px == complete.back().grey.px);
  CHECK(cut.at(1)->grey.px == complete[1].grey.px);
  CHECK_FALSE(cut.damage().empty());
}

TEST_CASE("files without frames are refused") {
  const media::ScratchFolder folder;
  media::write_bytes(folder / "empty.mp4", "");
  media::write_bytes(folder / "text.mp4", "not a video\n");
  for (const char* name : {"empty.mp4", "text.mp4", "absent.mp4"}) {
    INFO(name);
    CHECK_THROWS_AS(VideoFrames{folder / name}, Error);
  }
}

TEST_CASE("a histogram counts the finite grey values, and its quantiles leave out the extremes") {
  GrayF picture(100, 100);
  for (std::size_t i = 0; i < picture.px.size(); ++i) picture.px[i] = float(i % 1000);
  picture.px[3] = 60000;
  picture.px[4] = std::numeric_limits<float>::quiet_NaN();
  const GreyHistogram h = grey_histogram(picture);
  CHECK(h.least == 0);
  CHECK(h.most == 60000);
  // Ten of the 9999 values are 0, and ten are 999: the quantiles of 0.1 % and 99.9 % are beside these.
  CHECK(h.low >= 0);
  CHECK(h.low <= 1);
  CHECK(h.high >= 998);
  CHECK(h.high <= 999);
  std::int64_t all = 0;
  for (const std::int64_t n : h.counts) all += n;
  CHECK(all == 9999);
  CHECK(h.counts.back() == 1);
  const GreyHistogram none = grey_histogram(GrayF(3, 3, std::numeric_limits<float>::infinity()));
  CHECK(none.counts.empty());
  // Integer grey values are not divided, so that the histogram has no gaps.
  GrayF dim(2, 140);
  for (std::size_t i = 0; i < dim.px.size(); ++i) dim.px[i] = float(58 + i);
  const GreyHistogram even = grey_histogram(dim);
  CHECK(even.step == 2);
  CHECK(even.counts == std::vector<std::int64_t>(140, 2));
}

TEST_CASE("a displayed frame is averaged over squares and stretched between two grey values") {
  GrayF picture(9, 4);
  for (int row = 0; row < 4; ++row)
    for (int col = 0; col < 9; ++col) picture.at(col, row) = float(100 + 100 * (col / 3));
  const Gray8 full = displayed_frame(picture, {.width = 0, .low = 100, .high = 300});
  CHECK(full.width == 9);
  CHECK(full.at(0, 0) == 0);
  CHECK(full.at(4, 3) == 128);
  CHECK(full.at(8, 0) == 255);
  const Gray8 small = displayed_frame(picture, {.width = 3, .low = 200, .high = 250});
  CHECK(small.width == 3);
  CHECK(small.height == 1);
  CHECK(small.px == std::vector<std::uint8_t>{0, 0, 255});   // below black, black, above white
  CHECK(displayed_frame(picture, {.width = 8}).width == 4);  // at most the width asked for
  CHECK(displayed_png(picture, {}).starts_with("\x89PNG"));
}
