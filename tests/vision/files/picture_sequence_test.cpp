#include "vision/files/picture_sequence.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/error.h"
#include "tests/vision/media.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

void write_grey(const std::filesystem::path& path, int width, int height, int grey) {
  media::write_bytes(path, fmt::format("P5\n{} {}\n255\n", width, height) +
                               std::string(std::size_t(width * height), static_cast<char>(grey)));
}

std::vector<std::pair<int, double>> read_all(const std::filesystem::path& path, double fps) {
  VideoReader reader(path, fps);
  std::vector<std::pair<int, double>> out;
  GrayF g;
  for (double t = 0; reader.read(g, t);) out.emplace_back(int(g.at(0, 0)), t);
  return out;
}

}  // namespace

TEST_CASE("numbers in names are compared by value") {
  CHECK(natural_less("f9.png", "f10.png"));
  CHECK_FALSE(natural_less("f10.png", "f9.png"));
  CHECK(natural_less("f2a1", "f2a10"));
  CHECK(natural_less("a", "b"));
  CHECK(natural_less("f", "f1"));
  CHECK(natural_less("f01", "f1") != natural_less("f1", "f01"));
  CHECK_FALSE(natural_less("f1", "f1"));
  CHECK(natural_less("f00000000000000000000000000002", "f10000000000000000000000000000"));
}

TEST_CASE("a folder or a pattern is read as a video, in natural order, with times from --fps") {
  const media::ScratchFolder folder;
  for (const int k : {1, 2, 9, 10, 11}) write_grey(folder / fmt::format("f{}.pgm", k), 9, 6, 10 * k);
  write_grey(folder / "other.pgm", 9, 6, 255);
  media::write_bytes(folder / "notes.txt", "not a picture");
  media::write_bytes(folder / ".hidden.pgm", "not a picture");
  CHECK(read_all(folder.path(), 0).size() == 6);
  for (const char* pattern : {"f*.pgm", "f%d.pgm"}) {
    CAPTURE(pattern);
    const auto all = read_all(folder / pattern, 10);
    REQUIRE(all.size() == 5);
    const int grey[] = {10, 20, 90, 100, 110};
    const double t[] = {0, 0.1, 0.8, 0.9, 1.0};  // pictures 3 to 8 are missing: a gap in time
    for (std::size_t i = 0; i < 5; ++i) {
      CHECK(all[i].first == grey[i]);
      CHECK(all[i].second == doctest::Approx(t[i]));
    }
  }
  CHECK(read_all(folder / "f?.pgm", 0).size() == 3);
  CHECK(read_all(folder / "f%02d.pgm", 0).size() == 2);
  VideoReader reader(folder / "f*.pgm", 10);
  CHECK(reader.fps() == 10);
  CHECK(reader.width() == 9);
  CHECK(reader.frames_in_header() == 5);
  CHECK_FALSE(reader.truncated());
}

TEST_CASE("an empty sequence is refused; a damaged picture is skipped and reported") {
  const media::ScratchFolder folder;
  CHECK_THROWS_WITH_AS(VideoReader(folder / "f*.png"), doctest::Contains("no file matches"), Error);
  CHECK_THROWS_WITH_AS(VideoReader(folder.path()), doctest::Contains("contains no pictures"), Error);
  CHECK_THROWS_WITH_AS(VideoReader(folder / "none/f*.png"), doctest::Contains("none not found"), Error);
  for (int k = 0; k < 3; ++k) write_grey(folder / fmt::format("a{}.pgm", k), 9, 6, 10 + k);
  media::write_bytes(folder / "a1.pgm", "P5 nothing");
  VideoReader reader(folder / "a*.pgm", 10);
  GrayF g;
  double t = 0;
  int frames = 0;
  for (; reader.read(g, t); ++frames) CHECK(g.at(3, 3) == (frames == 0 ? 10 : 12));
  CHECK(frames == 2);
  CHECK(t == doctest::Approx(0.2));
  CHECK(reader.damaged_frames() == 1);
  CHECK(reader.damage().find("a1.pgm") != std::string::npos);
  write_grey(folder / "a3.pgm", 6, 9, 1);
  CHECK_THROWS_WITH_AS(read_all(folder / "a*.pgm", 10), doctest::Contains("6 x 9"), Error);
}

TEST_CASE("a frame rate override scales the times of a video") {
  const media::ScratchFolder folder;
  for (int k = 0; k < 3; ++k) write_grey(folder / fmt::format("a{}.pgm", k), 9, 6, 10 + k);
  CHECK(read_all(folder / "a*.pgm", 0).back().second == 2);  // no rate: index of the picture
  CHECK(read_all(folder / "a*.pgm", 4).back().second == doctest::Approx(0.5));
}
