#include "vision/files/tiff/tiff_stack.h"

#include <doctest/doctest.h>

#include <cstring>

#include "core/error.h"
#include "tests/vision/media.h"
#include "tests/vision/raw_files.h"
#include "vision/files/picture.h"
#include "vision/image/grey_of.h"

using namespace faba;
using media::TiffPage;

namespace {

constexpr std::uint32_t kWidth = 37, kHeight = 23;

// A value below `limit` that differs between neighbours, so that swapped rows, columns and channels are
// detected.
std::uint32_t value_at(std::uint32_t col, std::uint32_t row, std::uint32_t channel, std::uint32_t limit) {
  return (col * 1031 + row * 4099 + channel * 9973) % limit;
}

std::string samples(const TiffPage& page, std::uint32_t limit, bool big_endian) {
  std::string out;
  const int bytes = static_cast<int>(page.bits / 8);
  const std::uint32_t planes = page.planar == 2 ? page.samples : 1;
  const std::uint32_t beside = page.planar == 2 ? 1 : page.samples;
  const std::uint32_t tile_w = page.tile_width == 0 ? page.width : page.tile_width;
  const std::uint32_t tile_h = page.tile_width == 0 ? page.height : page.rows_per_strip;
  for (std::uint32_t plane = 0; plane < planes; ++plane) {
    for (std::uint32_t top = 0; top < page.height; top += tile_h) {
      for (std::uint32_t left = 0; left < page.width; left += tile_w) {
        for (std::uint32_t i = 0; i < tile_w * tile_h; ++i) {
          for (std::uint32_t c = 0; c < beside; ++c) {
            const auto value = value_at(left + i % tile_w, top + i / tile_w, plane + c, limit);
            out += media::bytes_of(value, bytes, big_endian);
          }
        }
      }
    }
  }
  return out;
}

GrayF read_single(const media::ScratchFolder& folder, const std::string& bytes, int expected_bits) {
  media::write_bytes(folder / "page.tif", bytes);
  TiffStack stack(folder / "page.tif");
  GrayF page;
  REQUIRE(stack.read(page));
  CHECK(stack.bits() == expected_bits);
  CHECK(page.width == int(kWidth));
  CHECK(page.height == int(kHeight));
  GrayF none;
  CHECK_FALSE(stack.read(none));
  return page;
}

template <class Expected>
int wrong_pixels(const GrayF& page, Expected expected) {
  int wrong = 0;
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::uint32_t col = 0; col < kWidth; ++col) {
      wrong += page.at(int(col), int(row)) != static_cast<float>(expected(col, row)) ? 1 : 0;
    }
  }
  return wrong;
}

}  // namespace

TEST_CASE("grey TIFF of 8 and 16 bits, both byte orders, strips and tiles: exact values") {
  const media::ScratchFolder folder;
  for (const std::uint32_t bits : {8U, 16U}) {
    for (const bool big_endian : {false, true}) {
      for (const std::uint32_t tile_width : {0U, 16U}) {
        CAPTURE(bits);
        CAPTURE(big_endian);
        CAPTURE(tile_width);
        TiffPage page{.width = kWidth, .height = kHeight, .bits = bits, .rows_per_strip = 0};
        if (tile_width != 0) {
          page.tile_width = tile_width;
          page.rows_per_strip = 32;
        }
        const std::uint32_t limit = 1U << bits;
        page.pixels = samples(page, limit, big_endian);
        if (tile_width == 0) page.rows_per_strip = 5;
        const GrayF grey = read_single(folder, media::tiff_file({page}, big_endian), int(bits));
        CHECK(wrong_pixels(grey, [&](auto col, auto row) { return value_at(col, row, 0, limit); }) == 0);
      }
    }
  }
}

TEST_CASE("MINISWHITE values are inverted") {
  const media::ScratchFolder folder;
  for (const std::uint32_t bits : {8U, 16U}) {
    TiffPage page{.width = kWidth, .height = kHeight, .bits = bits, .photometric = 0};
    const std::uint32_t limit = 1U << bits;
    page.pixels = samples(page, limit, false);
    const GrayF grey = read_single(folder, media::tiff_file({page}), int(bits));
    CHECK(wrong_pixels(grey, [&](auto c, auto r) { return limit - 1 - value_at(c, r, 0, limit); }) == 0);
  }
}

TEST_CASE(
    "colour TIFF is converted to grey by the weights, interleaved or planar, with or without a fourth "
    "channel") {
  const media::ScratchFolder folder;
  for (const std::uint32_t planar : {1U, 2U}) {
    for (const std::uint32_t channels : {3U, 4U}) {
      CAPTURE(planar);
      CAPTURE(channels);
      TiffPage page{.width = kWidth,
                    .height = kHeight,
                    .bits = 16,
                    .samples = channels,
                    .photometric = 2,
                    .planar = planar};
      page.pixels = samples(page, 65536, false);
      const GrayF grey = read_single(folder, media::tiff_file({page}), 16);
      const auto expected = [](auto col, auto row) {
        const auto channel = [&](std::uint32_t c) {
          return static_cast<float>(value_at(col, row, c, 65536));
        };
        return grey_of(channel(0), channel(1), channel(2));
      };
      CHECK(wrong_pixels(grey, expected) == 0);
    }
  }
}

TEST_CASE("12 bits are unpacked, signed and floating samples keep their values") {
  const media::ScratchFolder folder;
  SUBCASE("12 bits, rows padded to full bytes") {
    TiffPage page{.width = kWidth, .height = kHeight, .bits = 12};
    for (std::uint32_t row = 0; row < kHeight; ++row) {
      std::uint32_t store = 0, held = 0;
      for (std::uint32_t col = 0; col < kWidth; ++col) {
        store = (store << 12) | value_at(col, row, 0, 4096);
        for (held += 12; held >= 8; held -= 8) page.pixels += static_cast<char>((store >> (held - 8)) & 0xFF);
        store &= (1U << held) - 1;
      }
      if (held > 0) page.pixels += static_cast<char>(store << (8 - held));
    }
    const GrayF grey = read_single(folder, media::tiff_file({page}), 12);
    CHECK(wrong_pixels(grey, [](auto col, auto row) { return value_at(col, row, 0, 4096); }) == 0);
  }
  SUBCASE("signed 16 bits") {
    TiffPage page{.width = kWidth, .height = kHeight, .bits = 16, .format = 2};
    page.pixels = samples(page, 65536, false);
    const GrayF grey = read_single(folder, media::tiff_file({page}), 16);
    const auto expected = [](auto c, auto r) { return static_cast<std::int16_t>(value_at(c, r, 0, 65536)); };
    CHECK(wrong_pixels(grey, expected) == 0);
  }
  SUBCASE("float") {
    TiffPage page{.width = kWidth, .height = kHeight, .bits = 32, .format = 3};
    const auto expected = [](auto c, auto r) { return -3.25F + 0.125F * float(value_at(c, r, 0, 1000)); };
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const float value = expected(i % kWidth, i / kWidth);
      std::uint32_t pattern = 0;
      std::memcpy(&pattern, &value, sizeof pattern);
      page.pixels += media::bytes_of(pattern, 4, false);
    }
    const GrayF grey = read_single(folder, media::tiff_file({page}), 32);
    CHECK(wrong_pixels(grey, expected) == 0);
  }
  SUBCASE("one bit becomes 0 and 255") {
    TiffPage page{.width = kWidth, .height = kHeight, .bits = 1};
    for (std::uint32_t row = 0; row < kHeight; ++row) page.pixels += std::string("\xAA\xAA\xAA\xAA\xA8");
    const GrayF grey = read_single(folder, media::tiff_file({page}), 8);
    CHECK(wrong_pixels(grey, [](auto col, auto) { return col % 2 == 0 ? 255 : 0; }) == 0);
  }
}

TEST_CASE("a stack gives its pages in order without reduced-resolution pages, and the frame rate of ImageJ") {
  const media::ScratchFolder folder;
  std::vector<TiffPage> pages;
  for (std::uint32_t number = 0; number < 4; ++number) {
    TiffPage page{.width = kWidth, .height = kHeight};
    page.subfile = number == 2 ? 1 : 0;
    if (number == 0) page.description = "ImageJ=1.53t\nimages=4\nfinterval=0.05\ntunit=sec\n";
    page.pixels = std::string(kWidth * kHeight, static_cast<char>(10 * number));
    pages.push_back(page);
  }
  media::write_bytes(folder / "stack.tif", media::tiff_file(pages));
  TiffStack stack(folder / "stack.tif");
  CHECK(stack.pages() == 4);
  CHECK(stack.fps() == doctest::Approx(20).epsilon(1e-12));  // 1 / 0.05, correctly rounded twice
  GrayF page;
  for (const float expected : {0.0F, 10.0F, 30.0F}) {
    REQUIRE(stack.read(page));
    CHECK(wrong_pixels(page, [&](auto, auto) { return expected; }) == 0);
  }
  CHECK_FALSE(stack.read(page));
  CHECK_FALSE(stack.read(page));
}

TEST_CASE("a TIFF truncated anywhere is refused; the error has the path and the message of libtiff") {
  const media::ScratchFolder folder;
  TiffPage page{.width = kWidth, .height = kHeight, .bits = 16, .rows_per_strip = 4};
  page.pixels = samples(page, 65536, false);
  const std::string complete = media::tiff_file({page});
  const auto path = folder / "cut.tif";
  for (std::size_t length = 5; length + 1 < complete.size(); length += 97) {
    CAPTURE(length);
    media::write_bytes(path, complete.substr(0, length));
    GrayF grey;
    try {
      TiffStack stack(path);
      stack.read(grey);
      // Only the padding byte after the last list of the directory may be missing.
      CHECK(length + 2 >= complete.size());
    } catch (const Error& error) {
      CHECK(error.code() == Errc::input);
      CHECK(error.where() == path.string());
      CHECK(std::string(error.what()).find('(') != std::string::npos);
    }
  }
}

TEST_CASE("a header with an enormous picture size is refused before memory is allocated") {
  const media::ScratchFolder folder;
  TiffPage page{.width = 2'000'000, .height = 2'000'000, .rows_per_strip = 2'000'000};
  page.pixels = "too little";
  media::write_bytes(folder / "huge.tif", media::tiff_file({page}));
  CHECK_THROWS_AS(TiffStack{folder / "huge.tif"}, Error);
}
