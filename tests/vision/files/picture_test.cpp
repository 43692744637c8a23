#include "vision/files/picture.h"
#include "vision/image/grey_of.h"

#include <doctest/doctest.h>

#include <cmath>

#include <sys/resource.h>

#include <csignal>
#include <limits>

#include "core/error.h"
#include "tests/vision/media.h"
#include "tests/vision/raw_files.h"

using namespace faba;

namespace {

constexpr int kWidth = 37, kHeight = 23;

std::uint32_t value_at(int col, int row, std::uint32_t limit) {
  return static_cast<std::uint32_t>(col * 1031 + row * 4099) % limit;
}

template <class Expected>
int wrong_pixels(const GrayF& grey, Expected expected) {
  REQUIRE(grey.width == kWidth);
  REQUIRE(grey.height == kHeight);
  int wrong = 0;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      wrong += grey.at(col, row) != static_cast<float>(expected(col, row)) ? 1 : 0;
    }
  }
  return wrong;
}

std::string grey_rows(int bytes) {
  std::string rows;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    rows += media::bytes_of(value_at(i % kWidth, i / kWidth, bytes == 1 ? 256 : 65536), bytes, true);
  }
  return rows;
}

// The Error thrown when `path` is read; the test fails if there is no error.
Error refusal(const std::filesystem::path& path) {
  try {
    read_picture(path);
  } catch (const Error& error) {
    CHECK(error.code() == Errc::input);
    CHECK(error.where() == path.string());
    return error;
  }
  FAIL("no error for " << path.string());
  return {Errc::internal, "", ""};
}

bool message_contains(const Error& error, const std::string& word) {
  return std::string(error.what()).find(word) != std::string::npos;
}

}  // namespace

TEST_CASE("grey PNG and PGM of 8 and 16 bits: exact values") {
  const media::ScratchFolder folder;
  for (const int bytes : {1, 2}) {
    CAPTURE(bytes);
    const std::uint32_t limit = bytes == 1 ? 256 : 65536;
    const std::string size = std::to_string(kWidth) + " " + std::to_string(kHeight);
    media::write_bytes(folder / "p.png",
                       media::png_file(kWidth, kHeight, 8 * bytes, false, grey_rows(bytes)));
    media::write_bytes(folder / "p.pgm",
                       "P5\n" + size + "\n" + std::to_string(limit - 1) + "\n" + grey_rows(bytes));
    for (const char* name : {"p.png", "p.pgm"}) {
      CAPTURE(name);
      const Picture picture = read_picture(folder / name);
      CHECK(picture.bits == 8 * bytes);
      CHECK(picture.pages == 1);
      CHECK(wrong_pixels(picture.grey, [&](int col, int row) { return value_at(col, row, limit); }) == 0);
    }
  }
}

TEST_CASE("12 bits: every level of a PGM or TIFF stays a level of its own") {
  const media::ScratchFolder folder;
  std::string pgm = "P5\n64 64\n4095\n", packed;
  for (std::uint32_t v = 0; v < 4096; ++v) pgm += media::bytes_of(v, 2, true);
  for (std::uint32_t v = 0; v < 4096; v += 2) packed += media::bytes_of((v << 12U) | (v + 1), 3, true);
  media::write_bytes(folder / "p.pgm", pgm);
  media::TiffPage page;
  page.width = page.height = 64;
  page.bits = 12;
  page.pixels = packed;
  media::write_bytes(folder / "p.tif", media::tiff_file({page}));
  const Picture grey = read_picture(folder / "p.pgm"), tiff = read_picture(folder / "p.tif");
  CHECK(grey.bits == 16);
  CHECK(tiff.bits == 12);
  int wrong = 0;
  for (int v = 0; v < 4096; ++v) {
    wrong += std::lround(double(grey.grey.px[std::size_t(v)]) * 4095 / 65535) != v;
    wrong += tiff.grey.px[std::size_t(v)] != float(v);
  }
  CHECK(wrong == 0);
}

TEST_CASE("read_displayed: the colours of a file, and a grey picture stretched") {
  const media::ScratchFolder folder;
  std::string colours, greys;
  for (int i = 0; i < 64 * 48; ++i) {
    colours += {char(200), char(30), char(i % 64)};
    greys += std::string(3, char(100 + i % 8));
  }
  media::TiffPage page;
  page.width = 64;
  page.height = 48;
  page.samples = 3;
  page.photometric = 2;
  page.pixels = colours;
  media::write_bytes(folder / "c.tif", media::tiff_file({page}));
  media::write_bytes(folder / "c.ppm", "P6\n64 48\n255\n" + colours);
  page.pixels = greys;
  media::write_bytes(folder / "g.tif", media::tiff_file({page}));
  media::write_bytes(folder / "g.ppm", "P6\n64 48\n255\n" + greys);
  for (const char* name : {"c.tif", "c.ppm"})
    CHECK(read_displayed(folder / name).at(5, 7) == Rgb{200, 30, 5});
  for (const char* name : {"g.tif", "g.ppm"}) {
    const RgbImage grey = read_displayed(folder / name);
    CHECK(grey.at(0, 3) == Rgb{0, 0, 0});
    CHECK(grey.at(7, 3) == Rgb{255, 255, 255});
  }
}

TEST_CASE("the format is detected from the content, not from the file name") {
  const media::ScratchFolder folder;
  media::write_bytes(folder / "really_png.tif", media::png_file(kWidth, kHeight, 8, false, grey_rows(1)));
  CHECK(wrong_pixels(read_picture(folder / "really_png.tif").grey,
                     [](int c, int r) { return value_at(c, r, 256); }) == 0);
}

TEST_CASE("colour is converted to grey by the weights; r = g = b keeps its value") {
  const media::ScratchFolder folder;
  std::string rows;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    for (const std::uint32_t factor : {1U, 7U, 13U}) {
      const std::uint32_t value = value_at(i % kWidth, i / kWidth, 65536);
      rows += media::bytes_of(i % 2 == 0 ? value : value * factor % 65536, 2, true);
    }
  }
  media::write_bytes(folder / "c.png", media::png_file(kWidth, kHeight, 16, true, rows));
  const Picture picture = read_picture(folder / "c.png");
  CHECK(picture.bits == 16);
  const auto expected = [](int col, int row) {
    const std::uint32_t v = value_at(col, row, 65536);
    if ((row * kWidth + col) % 2 == 0) return static_cast<float>(v);
    const auto channel = [&](std::uint32_t factor) { return static_cast<float>(v * factor % 65536); };
    return 0.2989F * channel(1) + 0.5870F * channel(7) + 0.1140F * channel(13);
  };
  CHECK(wrong_pixels(picture.grey, expected) == 0);
}

TEST_CASE("write_png round-trips exactly, also at odd sizes and over an existing file") {
  const media::ScratchFolder folder;
  RgbImage colour = media::scene(kWidth, kHeight, 3, true);
  write_png(folder / "colour.png", RgbImage(5, 7));
  write_png(folder / "colour.png", colour);
  const auto expected = [&](int col, int row) {
    const Rgb p = colour.at(col, row);
    return grey_of(float(p.r), float(p.g), float(p.b));
  };
  CHECK(wrong_pixels(read_picture(folder / "colour.png").grey, expected) == 0);

  Gray8 grey(kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) grey.px[std::size_t(i)] = static_cast<std::uint8_t>(i * 7);
  write_png(folder / "grey.png", grey);
  CHECK(wrong_pixels(read_picture(folder / "grey.png").grey, [&](int c, int r) { return grey.at(c, r); }) ==
        0);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) ==
        2);  // no temporary file remains
}

TEST_CASE("write_png to a path that cannot be written") {
  const media::ScratchFolder folder;
  try {
    write_png(folder / "no such folder/p.png", Gray8(3, 2));
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::internal);
    CHECK(message_contains(error, "no such folder"));
  }
  CHECK_THROWS_AS(write_png(folder / "empty.png", Gray8()), Error);
}

TEST_CASE("on a full disk the existing picture is kept and no temporary file remains") {
  const media::ScratchFolder folder;
  write_png(folder / "p.png", Gray8(3, 2, 9));
  const std::string before = media::read_bytes(folder / "p.png");
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20, old.rlim_max};  // bytes; less than any PNG
  setrlimit(RLIMIT_FSIZE, &small);
  bool refused = false;
  try {
    write_png(folder / "p.png", Gray8(30, 20, 200));
  } catch (const Error& error) {
    refused = error.code() == Errc::internal;
  }
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  CHECK(refused);
  CHECK(media::read_bytes(folder / "p.png") == before);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a file that is not a picture is refused; the error has the path and the reason") {
  const media::ScratchFolder folder;
  CHECK(message_contains(refusal(folder / "missing.png"), "file not found"));
  CHECK(message_contains(refusal(folder.path()), "directory"));
  media::write_bytes(folder / "empty.png", "");
  CHECK(message_contains(refusal(folder / "empty.png"), "empty"));
  media::write_bytes(folder / "notes.txt", "These are notes, and no picture at all.\n");
  refusal(folder / "notes.txt");
  media::write_bytes(folder / "notes.png", "These are notes, and no picture at all.\n");
  refusal(folder / "notes.png");
  media::write_bytes(folder / "list.m3u8",
                     "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://127.0.0.1:9/a.ts\n");
  refusal(folder / "list.m3u8");
}

TEST_CASE("a PGM header may be on one line, or have one field and a comment per line") {
  const media::ScratchFolder folder;
  for (const char* header : {"P5 37 23 65535\n", "P5\n# a comment\n37\n23\n65535\n"}) {
    media::write_bytes(folder / "p.pgm", header + grey_rows(2));
    CHECK(wrong_pixels(read_picture(folder / "p.pgm").grey,
                       [](int col, int row) { return value_at(col, row, 65536); }) == 0);
  }
}

TEST_CASE("a PNG or PGM truncated anywhere is refused, not padded") {
  const media::ScratchFolder folder;
  const std::string png = media::png_file(kWidth, kHeight, 16, false, grey_rows(2));
  const std::string pgm = "P5\n37 23\n65535\n" + grey_rows(2);
  const std::size_t png_end = 12;  // the IEND chunk has no data
  for (std::size_t length = 1; length < png.size() - png_end; length += 53) {
    CAPTURE(length);
    media::write_bytes(folder / "cut.png", png.substr(0, length));
    refusal(folder / "cut.png");
  }
  for (std::size_t length = 1; length < pgm.size(); length += 53) {
    CAPTURE(length);
    media::write_bytes(folder / "cut.pgm", pgm.substr(0, length));
    refusal(folder / "cut.pgm");
  }
}

TEST_CASE("stretched maps the given quantiles to 0 and 255") {
  GrayF ramp(101, 1);
  for (int i = 0; i <= 100; ++i) ramp.at(i, 0) = static_cast<float>(1000 + 2 * i);
  const Gray8 full_range = stretched(ramp, 0, 1);
  for (int i = 0; i <= 100; ++i) CHECK(full_range.at(i, 0) == std::lround(2.55 * i));
  const Gray8 middle = stretched(ramp, 0.1, 0.9);  // 1020 becomes 0, 1180 becomes 255
  CHECK(middle.at(0, 0) == 0);
  CHECK(middle.at(10, 0) == 0);
  CHECK(middle.at(50, 0) == 128);  // 127.5, rounded up
  CHECK(middle.at(90, 0) == 255);
  CHECK(middle.at(100, 0) == 255);
}

TEST_CASE("stretched: uniform, sparse and non-finite pictures") {
  CHECK(stretched(GrayF(7, 5, 300.0F)).px == std::vector<std::uint8_t>(35, 128));
  CHECK(stretched(GrayF()).empty());
  GrayF spot(20, 10, 5.0F);
  spot.at(3, 4) = 9;
  CHECK(stretched(spot).at(3, 4) == 255);
  CHECK(stretched(spot).at(4, 3) == 0);
  GrayF non_finite(3, 2, std::numeric_limits<float>::quiet_NaN());
  CHECK(stretched(non_finite).px == std::vector<std::uint8_t>(6, 0));
  non_finite.at(0, 0) = std::numeric_limits<float>::infinity();
  non_finite.at(1, 0) = -std::numeric_limits<float>::max();
  non_finite.at(2, 0) = std::numeric_limits<float>::max();
  CHECK(stretched(non_finite, 0, 1).px == std::vector<std::uint8_t>{0, 0, 255, 0, 0, 0});
  CHECK_THROWS_AS(stretched(spot, 0.9, 0.1), Error);
  CHECK_THROWS_AS(stretched(spot, -0.1, 0.5), Error);
}
