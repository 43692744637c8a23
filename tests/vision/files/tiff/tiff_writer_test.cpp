#include "vision/files/tiff/tiff_writer.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "tests/vision/media.h"
#include "vision/files/frame_interval.h"
#include "vision/files/tiff/tiff_stack.h"
#include "vision/files/tiff_export.h"
#include "vision/files/video_reader.h"
#include "vision/files/video_writer.h"

using namespace faba;

namespace {

// Page k of a stack of odd size: values up to the maximum of the type.
template <class Pixel>
Image<Pixel> page(int k) {
  Image<Pixel> p(7, 5);
  for (std::size_t i = 0; i < p.px.size(); ++i)
    p.px[i] = Pixel((std::size_t(k) * 5003 + i * 7001) % (sizeof(Pixel) == 1 ? 256 : 65536));
  return p;
}

std::vector<GrayF> pages_of(const std::filesystem::path& file) {
  TiffStack stack(file);
  std::vector<GrayF> pages(1);
  while (stack.read(pages.back())) pages.emplace_back();
  pages.pop_back();
  return pages;
}

template <class Pixel>
void check_round_trip(TiffPixels pixels, int bits) {
  for (const char* name : {"a.ome.tif", "a.tif"})
    for (const std::uint64_t most_classic : {std::uint64_t(0xFFFFFFFF), std::uint64_t(200)}) {
      CAPTURE(name);
      CAPTURE(most_classic);
      const media::ScratchFolder f;
      TiffWriter writer(f / name, 7, 5, pixels, most_classic);
      for (int k = 0; k < 4; ++k) writer.write(page<Pixel>(k));
      CHECK_FALSE(std::filesystem::exists(f / name));
      const bool big = writer.finish(*tiff_kind(f / name), {0.35, 0.04});
      CHECK(big == (most_classic == 200));
      CHECK(media::read_bytes(f / name).substr(0, 4) ==
            (big ? std::string("II+\0", 4) : std::string("II*\0", 4)));
      TiffStack stack(f / name);
      CHECK(stack.bits() == bits);
      CHECK(stack.pages() == 4);
      REQUIRE(stack.metadata().um_per_px);
      CHECK(*stack.metadata().um_per_px == doctest::Approx(0.35).epsilon(1e-6));
      CHECK(stack.fps() == doctest::Approx(25).epsilon(1e-9));
      CHECK(stack.metadata().ignored.empty());
      const std::vector<GrayF> read = pages_of(f / name);
      REQUIRE(read.size() == 4);
      for (int k = 0; k < 4; ++k)
        CHECK(std::ranges::equal(read[std::size_t(k)].px, page<Pixel>(k).px,
                                 [](float a, Pixel b) { return a == float(b); }));
    }
}

}  // namespace

TEST_CASE("a TIFF stack of each type of pixels, classic and BigTIFF, is read back with scale and interval") {
  check_round_trip<std::uint8_t>(TiffPixels::grey8, 8);
  check_round_trip<std::uint16_t>(TiffPixels::grey16, 16);
  check_round_trip<float>(TiffPixels::grey_float, 32);
}

TEST_CASE("TIFF: scales over the complete range are kept; an unknown one is not written") {
  const media::ScratchFolder f;
  for (const char* name : {"a.ome.tif", "a.tif"}) {
    for (const double um : {0.001, 0.0012345678, 0.0645, 0.9164, 1.0, 3.33333, 47.11, 999.9}) {
      CAPTURE(um);
      TiffWriter writer(f / name, 7, 5, TiffPixels::grey8);
      writer.write(page<std::uint8_t>(0));
      writer.finish(*tiff_kind(f / name), {um, 0.001});
      const auto stated = TiffStack(f / name).metadata();
      REQUIRE(stated.um_per_px);
      CHECK(*stated.um_per_px == doctest::Approx(um).epsilon(2e-6));
      CHECK(stated.fps == doctest::Approx(1000).epsilon(1e-9));
    }
    TiffWriter writer(f / name, 7, 5, TiffPixels::grey8);
    writer.write(page<std::uint8_t>(0));
    writer.finish(*tiff_kind(f / name), {});
    const auto stated = TiffStack(f / name).metadata();
    CHECK_FALSE(stated.um_per_px);
    CHECK(stated.fps == 0);
    CHECK(stated.ignored.empty());
    const std::string bytes = media::read_bytes(f / name);
    CHECK(bytes.find("micron") == std::string::npos);
    CHECK(bytes.find("PhysicalSize") == std::string::npos);
  }
}

TEST_CASE("TIFF: colours, names, and files that are not completed") {
  CHECK(tiff_kind("a.ome.tif") == TiffKind::ome);
  CHECK(tiff_kind("a.ome.tiff") == TiffKind::ome);
  CHECK(tiff_kind("ome.tif") == TiffKind::imagej);
  CHECK(tiff_kind("a.b.tiff") == TiffKind::imagej);
  CHECK_FALSE(tiff_kind("a"));
  CHECK_FALSE(tiff_kind("a.ome"));
  const media::ScratchFolder f;
  {
    TiffWriter writer(f / "c.tif", 9, 6, TiffPixels::colour);
    writer.write(media::scene(9, 6, 0, true));
    writer.finish(TiffKind::imagej, {});
    RgbImage back;
    TiffStack stack(f / "c.tif");
    stack.read_colours(back);
    CHECK(back.px == media::scene(9, 6, 0, true).px);
  }
  {
    TiffWriter writer(f / "d.tif", 9, 6, TiffPixels::grey8);
    CHECK_THROWS_AS(writer.write(Gray8(9, 7)), Error);
    CHECK_THROWS_AS(writer.write(GrayF(9, 6)), Error);
    CHECK_THROWS_AS(writer.finish(TiffKind::imagej, {}), Error);
  }
  CHECK(std::distance(std::filesystem::directory_iterator(f.path()), {}) == 1);
  CHECK_THROWS_AS(TiffWriter("/dev/full/x.tif", 9, 6, TiffPixels::grey8), Error);
}

TEST_CASE("export of a video: part, interval, values out of range, and interruption") {
  const media::ScratchFolder f;
  {
    VideoWriter writer(f / "v.part", VideoFormat::lossless_avi, 20, 10, 12.5, 0, VideoPixels::grey8);
    for (int k = 0; k < 25; ++k) writer.write(Gray8(20, 10, std::uint8_t(k)));
    writer.finish(f / "v.avi");
  }
  const auto exported = [&](double from_s, std::optional<double> to_s, double fps = 0,
                            std::int64_t stop = 99) {
    VideoReader video(f / "v.avi", fps);
    return export_tiff(video, {.out = f / "out.tif",
                               .um_per_px = 2,
                               .from_s = from_s,
                               .to_s = to_s,
                               .progress = [&](std::int64_t done, std::int64_t) { return done < stop; }});
  };
  CHECK(exported(0.8, 1.2).frames == 6);
  CHECK(pages_of(f / "out.tif")[0].px[0] == 10);
  CHECK(*exported(0, {}, 100).frame_s == doctest::Approx(0.01));
  const TiffExported all = exported(0, {});
  CHECK(all.frames == 25);
  CHECK(all.regular);
  CHECK(*all.frame_s == doctest::Approx(0.08).epsilon(1e-9));
  CHECK(TiffStack(f / "out.tif").fps() == doctest::Approx(12.5));
  CHECK(pages_of(f / "out.tif")[24].px[7] == 24);

  CHECK_THROWS_WITH_AS(exported(50, {}), doctest::Contains("change --from and --to"), Error);
  CHECK_THROWS_AS(exported(0, {}, 0, 3), Error);
  CHECK_FALSE(std::filesystem::exists(f / "out.tif.tmp"));
  CHECK(pages_of(f / "out.tif").size() == 25);  // the earlier file is kept
}

TEST_CASE("frame interval: gaps are left out, rounding does not bias it") {
  CHECK_FALSE(frame_interval(std::vector<double>{}));
  CHECK_FALSE(frame_interval(std::vector<double>{3}));
  CHECK_FALSE(frame_interval(std::vector<double>{3, 3, 3}));
  CHECK_FALSE(frame_interval(std::vector<double>{3, 2, 1}));
  const auto gap = frame_interval(std::vector<double>{0, 0.1, 0.2, 0.5, 0.6, 0.7});
  CHECK(gap->s == doctest::Approx(0.1));
  CHECK_FALSE(gap->regular);
  std::vector<double> rounded;
  for (int k = 0; k < 300; ++k) rounded.push_back(std::round(1000 * k / 29.97) / 1000);
  CHECK(frame_interval(rounded)->s == doctest::Approx(1 / 29.97).epsilon(1e-4));
  CHECK(frame_interval(rounded)->regular);
}
