#include "vision/files/video_reader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "tests/vision/media.h"
#include "tests/vision/raw_files.h"
#include "vision/files/video_writer.h"

using namespace faba;

namespace {

constexpr int kWidth = 94, kHeight = 62;

Error refusal(const std::filesystem::path& path) {
  try {
    VideoReader reader(path);
  } catch (const Error& error) {
    CHECK(error.code() == Errc::input);
    CHECK(error.where() == path.string());
    return error;
  }
  FAIL("no error for " << path.string());
  return {Errc::internal, "", ""};
}

std::filesystem::path record(const media::ScratchFolder& folder, VideoFormat format, int frames) {
  VideoWriter writer(folder / "made.part", format, kWidth, kHeight, 10);
  for (int frame = 0; frame < frames; ++frame) writer.write(media::scene(kWidth, kHeight, frame, true));
  writer.finish(folder / "made");
  return folder / "made";
}

std::vector<GrayF> read_all(VideoReader& reader) {
  std::vector<GrayF> frames;
  GrayF grey;
  for (double t_s = 0; reader.read(grey, t_s);) frames.push_back(grey);
  return frames;
}

// An AVI of one uncompressed frame of 4 x 2 px in a packed format whose luma has studio range.
std::string studio_range_avi(const std::string& four_character_code, int bits, const std::string& pixels) {
  const auto u32 = [](std::uint64_t v) { return media::bytes_of(v, 4, false); };
  const auto u16 = [](std::uint64_t v) { return media::bytes_of(v, 2, false); };
  const auto chunk = [&](const std::string& name, const std::string& data) {
    return name + u32(data.size()) + data;
  };
  const auto list = [&](const std::string& name, const std::string& data) {
    return chunk("LIST", name + data);
  };
  const std::string main = u32(40000) + u32(0) + u32(0) + u32(0) + u32(1) + u32(0) + u32(1) + u32(0) +
                           u32(4) + u32(2) + std::string(16, '\0');
  const std::string stream = "vids" + four_character_code + u32(0) + u32(0) + u32(0) + u32(1) + u32(25) +
                             u32(0) + u32(1) + u32(0) + u32(0) + u32(0) + u16(0) + u16(0) + u16(4) + u16(2);
  const std::string format = u32(40) + u32(4) + u32(2) + u16(1) + u16(std::uint64_t(bits)) +
                             four_character_code + u32(pixels.size()) + std::string(16, '\0');
  const std::string header =
      list("hdrl", chunk("avih", main) + list("strl", chunk("strh", stream) + chunk("strf", format)));
  return chunk("RIFF", "AVI " + header + list("movi", chunk("00dc", pixels)));
}

}  // namespace

TEST_CASE("a file that is not a video is refused; the error has the path and the reason") {
  const media::ScratchFolder folder;
  CHECK(std::string(refusal(folder / "missing.mp4").what()).find("file not found") != std::string::npos);
  refusal(folder.path());
  media::write_bytes(folder / "empty.mp4", "");
  CHECK(std::string(refusal(folder / "empty.mp4").what()).find("empty") != std::string::npos);
  media::write_bytes(folder / "noise.mp4", std::string(5000, 'x'));
  refusal(folder / "noise.mp4");
}

TEST_CASE("time stamps come from the file, also at a variable frame rate") {
  const media::ScratchFolder folder;
  media::write_bytes(folder / "v.gif", media::gif_file(13, 7, {{20, 10}, {60, 30}, {100, 5}, {140, 20}}));
  VideoReader reader(folder / "v.gif");
  CHECK(reader.width() == 13);
  CHECK(reader.height() == 7);
  GrayF grey;
  double t_s = -1;
  for (const auto& [level, t] :
       {std::pair{20.0F, 0.0}, std::pair{60.0F, 0.10}, std::pair{100.0F, 0.40}, std::pair{140.0F, 0.45}}) {
    REQUIRE(reader.read(grey, t_s));
    CHECK(grey.at(12, 6) == level);
    CHECK(std::abs(t_s - t) < 1e-12);  // multiples of 1/100 of a second, rounded to double
  }
  CHECK_FALSE(reader.read(grey, t_s));
  CHECK_FALSE(reader.truncated());
}

TEST_CASE("studio range is stretched to 0..255 and clipped") {
  const media::ScratchFolder folder;
  // UYVY: chroma 128 between luma 16, 235, 126, 17 / 0, 255, 100, 200.
  media::write_bytes(folder / "v.avi",
                     studio_range_avi("UYVY", 16,
                                      "\x80\x10\x80\xEB\x80\x7E\x80\x11" +
                                          std::string("\x80\x00\x80\xFF\x80\x64\x80\xC8", 8)));
  VideoReader reader(folder / "v.avi");
  GrayF grey;
  double t_s = 0;
  REQUIRE(reader.read(grey, t_s));
  const std::vector<int> stored = {16, 235, 126, 17, 0, 255, 100, 200};
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const double expected = std::clamp((stored[i] - 16) * 255.0 / 219.0, 0.0, 255.0);
    CHECK(std::abs(double{grey.px[i]} - expected) < 255 * 3 * 6e-8);  // three float roundings
  }
}

TEST_CASE("grey without a range tag is full range") {
  const media::ScratchFolder folder;
  media::write_bytes(folder / "v.avi",
                     studio_range_avi("Y800", 8, std::string("\x00\x01\x10\x11\x64\xEB\xFE\xFF", 8)));
  VideoReader reader(folder / "v.avi");
  GrayF grey;
  double t_s = 0;
  REQUIRE(reader.read(grey, t_s));
  CHECK(grey.px == std::vector<float>{0, 1, 16, 17, 100, 235, 254, 255});
}

TEST_CASE("a TIFF stack is read as a video; the frame rate may be unknown") {
  const media::ScratchFolder folder;
  for (const bool timed : {false, true}) {
    std::vector<media::TiffPage> pages(3);
    for (std::size_t i = 0; i < pages.size(); ++i) {
      pages[i].width = 11;
      pages[i].height = 6;
      pages[i].pixels = std::string(66, static_cast<char>(i + 1));
    }
    if (timed) pages[0].description = "ImageJ=1.53t\nfps=4\n";
    media::write_bytes(folder / "s.tif", media::tiff_file(pages));
    VideoReader reader(folder / "s.tif");
    CHECK(reader.fps() == (timed ? 4 : 0));
    CHECK(reader.frames_in_header() == 3);
    GrayF grey;
    double t_s = 0;
    for (int page = 0; page < 3; ++page) {
      REQUIRE(reader.read(grey, t_s));
      CHECK(grey.at(10, 5) == float(page + 1));
      CHECK(t_s == (timed ? page / 4.0 : page));
    }
    CHECK_FALSE(reader.read(grey, t_s));
    CHECK_FALSE(reader.truncated());
  }
}

TEST_CASE(
    "a truncated TIFF stack gives the complete pages and reports the truncation; a page of different size is "
    "refused") {
  const media::ScratchFolder folder;
  std::vector<media::TiffPage> pages(3);
  for (auto& page : pages) {
    page.width = 11;
    page.height = 6;
    page.pixels = std::string(66, '7');
  }
  const std::string complete = media::tiff_file(pages);
  media::write_bytes(folder / "s.tif", complete.substr(0, complete.size() - 100));
  VideoReader reader(folder / "s.tif");
  CHECK(read_all(reader).size() == 2);
  CHECK(reader.truncated());
  CHECK(reader.damage().find("page 3") != std::string::npos);

  pages[1].width = 6;
  pages[1].height = 11;
  media::write_bytes(folder / "s.tif", media::tiff_file(pages));
  VideoReader changing(folder / "s.tif");
  CHECK_THROWS_AS(read_all(changing), Error);
}

namespace {

// Several decoding threads give the same frames, the same end and the same words about damage.
void same_with_threads(const std::filesystem::path& path) {
  struct Read {
    std::vector<GrayF> frames;
    bool truncated = false;
    std::int64_t damaged = 0;
    std::string damage;
  };
  const auto read = [&](unsigned threads) {
    Read r;
    try {
      VideoReader reader(path, 0, threads);
      r.frames = read_all(reader);
      r.truncated = reader.truncated();
      r.damaged = reader.damaged_frames();
      r.damage = reader.damage();
    } catch (const Error& error) {
      r.damage = error.what();
    }
    return r;
  };
  const Read one = read(1);
  for (const unsigned threads : {2u, 5u}) {
    CAPTURE(threads);
    const Read several = read(threads);
    REQUIRE(several.frames.size() == one.frames.size());
    for (std::size_t i = 0; i < one.frames.size(); ++i) CHECK(several.frames[i].px == one.frames[i].px);
    CHECK(several.truncated == one.truncated);
    CHECK(several.damaged == one.damaged);
    CHECK(several.damage == one.damage);
  }
}

}  // namespace

TEST_CASE("a truncated video gives the frames of the complete one, then false and the reason") {
  const media::ScratchFolder folder;
  for (const auto format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    CAPTURE(int(format));
    const auto path = record(folder, format, 25);
    VideoReader complete(path);
    const std::vector<GrayF> frames = read_all(complete);
    REQUIRE(frames.size() == 25);
    same_with_threads(path);
    const std::string bytes = media::read_bytes(path);
    std::size_t most_frames = 0;
    for (int tenth = 1; tenth < 10; ++tenth) {
      CAPTURE(tenth);
      media::write_bytes(folder / "cut", bytes.substr(0, bytes.size() * std::size_t(tenth) / 10));
      same_with_threads(folder / "cut");
      try {
        VideoReader cut(folder / "cut");
        const std::vector<GrayF> some = read_all(cut);
        CHECK(some.size() < 25);
        CHECK(cut.truncated());
        CHECK_FALSE(cut.damage().empty());
        for (std::size_t i = 0; i < some.size(); ++i) CHECK(some[i].px == frames[i].px);
        most_frames = std::max(most_frames, some.size());
      } catch (const Error& error) {
        CHECK(error.code() == Errc::input);  // no complete frame is left
        CHECK(tenth < 5);
      }
    }
    CHECK(most_frames >= 15);
  }
}

TEST_CASE("truncation exactly between two frames of an mp4 is detected") {
  const media::ScratchFolder folder;
  const std::string bytes = media::read_bytes(record(folder, VideoFormat::mp4, 6));
  // The table of frame sizes: name, version, common size (0), count, then one number per frame.
  const std::size_t table = bytes.find("stsz");
  std::size_t last_size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    last_size = last_size << 8 | static_cast<std::uint8_t>(bytes[table + 16 + std::size_t{5} * 4 + i]);
  }
  media::write_bytes(folder / "cut.mp4", bytes.substr(0, bytes.size() - last_size));
  VideoReader cut(folder / "cut.mp4");
  CHECK(read_all(cut).size() == 5);
  CHECK(cut.truncated());
}

TEST_CASE("an mp4 of which the edit list ends before the last frame has one frame less, and is not damaged") {
  const media::ScratchFolder folder;
  constexpr int kFrames = 30;  // at 10 Hz
  std::string bytes = media::read_bytes(record(folder, VideoFormat::mp4, kFrames));
  // The list of edits: name, version, count (1), then the duration in ms.
  const std::size_t duration = bytes.find("elst") + 12;
  constexpr unsigned kShorter = (kFrames - 1) * 100;
  for (std::size_t i = 0; i < 4; ++i) bytes[duration + i] = char(kShorter >> (24 - 8 * i) & 0xFF);
  media::write_bytes(folder / "edited.mp4", bytes);
  for (const unsigned threads : {1U, 3U}) {
    CAPTURE(threads);
    VideoReader edited(folder / "edited.mp4", 0, threads);
    CHECK(read_all(edited).size() == kFrames - 1);
    CHECK_FALSE(edited.truncated());
    CHECK(edited.damage().empty());
    CHECK(edited.seek(1) == (threads == 1));  // it was not read again by one thread, as a damaged file is
  }
  VideoReader part(folder / "edited.mp4");
  part.skip_to(2.85);
  CHECK(read_all(part).size() == kFrames - 1 - 20);  // key frames at 0, 10 and 20
}

TEST_CASE("no error concealment: after damage, frames are skipped until the next key frame") {
  const media::ScratchFolder folder;
  const auto path = record(folder, VideoFormat::mp4, 30);  // key frames at 0, 10 and 20
  VideoReader complete(path);
  const std::vector<GrayF> frames = read_all(complete);
  const std::string bytes = media::read_bytes(path);
  const std::size_t data = bytes.find("mdat");
  for (int damage_at = 4; damage_at < 20; ++damage_at) {  // the first bytes are the encoder's signature
    CAPTURE(damage_at);
    std::string damaged_bytes = bytes;
    const std::size_t at = data + (bytes.size() - data) * std::size_t(damage_at) / 20;
    for (std::size_t i = at; i < at + 30; ++i) damaged_bytes[i] = damage_at % 2 == 0 ? '\0' : '\xFF';
    media::write_bytes(folder / "damaged.mp4", damaged_bytes);
    same_with_threads(folder / "damaged.mp4");
    VideoReader damaged(folder / "damaged.mp4");
    GrayF grey;
    double t_s = 0;
    std::size_t count = 0;
    // Time stamps count from the first complete frame, which may not be the first of the file.
    std::size_t offset = frames.size();
    while (damaged.read(grey, t_s)) {
      const auto frame = std::size_t(std::lround(t_s * 10));
      if (offset == frames.size()) {
        for (offset = 0; offset < frames.size() && frames[offset].px != grey.px;) offset += 10;
      }
      REQUIRE(frame + offset < frames.size());
      CHECK(grey.px == frames[frame + offset].px);
      ++count;
    }
    CHECK(count < frames.size());
    CHECK(count + std::size_t(damaged.damaged_frames()) == frames.size());
    CHECK_FALSE(damaged.damage().empty());
  }
}

TEST_CASE(
    "skip_to: the next frame is the last key frame not after the time, and all frames after it follow") {
  const media::ScratchFolder folder;
  constexpr int kFrames = 47;
  for (const VideoFormat format : {VideoFormat::mp4, VideoFormat::lossless_avi}) {
    const auto video =
        record(folder, format, kFrames);  // 10 frames per second; mp4 has a key frame each second
    VideoReader complete(video);
    const std::vector<GrayF> all = read_all(complete);
    REQUIRE(all.size() == kFrames);
    const int group = format == VideoFormat::mp4 ? 10 : 1;
    for (const double t : {0.0, 0.05, 0.9, 1.0, 1.05, 2.99, 4.6, 100.0})
      for (const int before : {0, 1, 7, 12}) {
        INFO("to ", t, " after ", before, " frames");
        VideoReader reader(video);
        GrayF grey;
        double t_s = 0;
        for (int i = 0; i < before; ++i) REQUIRE(reader.read(grey, t_s));
        const int key = std::min(kFrames - 1, int(t * 10 + 1e-9)) / group * group;
        const int next = std::max(before, key);
        CHECK(reader.skip_to(t) == next - before);
        for (int i = next; i < kFrames; ++i) {
          REQUIRE(reader.read(grey, t_s));
          CHECK(t_s == doctest::Approx(i / 10.0));
          CHECK(grey.px == all[std::size_t(i)].px);
        }
        CHECK_FALSE(reader.read(grey, t_s));
        CHECK_FALSE(reader.truncated());
        CHECK(reader.damaged_frames() == 0);
      }
    // Several times in one pass, and never backwards.
    VideoReader reader(video);
    GrayF grey;
    double t_s = 0;
    for (const double t : {0.0, 1.2, 1.3, 3.0, 4.6}) {
      reader.skip_to(t);
      REQUIRE(reader.read(grey, t_s));
      CHECK(grey.px == all[std::size_t(std::lround(10 * t_s))].px);
      CHECK(t_s <= t + 0.11);
    }
  }
}

TEST_CASE("skip_to: a truncated video is still reported, with its frames before the damage") {
  const media::ScratchFolder folder;
  const auto video = record(folder, VideoFormat::lossless_avi, 30);
  const std::string bytes = media::read_bytes(video);
  media::write_bytes(folder / "short.avi", bytes.substr(0, bytes.size() / 2));
  VideoReader reader(folder / "short.avi");
  CHECK(reader.skip_to(0.5) == 5);
  const std::size_t left = read_all(reader).size();
  CHECK(left > 3);
  CHECK(left < 25);
  CHECK(reader.truncated());
}

TEST_CASE("two readers are independent, and a reader can be moved") {
  const media::ScratchFolder folder;
  const auto path = record(folder, VideoFormat::mp4, 4);
  VideoReader a(path), b(path);
  GrayF first, second;
  double t_s = 0;
  REQUIRE(a.read(first, t_s));
  REQUIRE(a.read(first, t_s));
  VideoReader moved = std::move(a);
  REQUIRE(moved.read(first, t_s));
  for (int i = 0; i < 3; ++i) REQUIRE(b.read(second, t_s));
  CHECK(first.px == second.px);
}
