#include "vision/flow/flow_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

Flow some_flow(int width, int height, float seed) {
  Flow f{GrayF(width, height), GrayF(width, height)};
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      f.u.at(c, r) = seed + float(c) / 7;
      f.v.at(c, r) = seed - float(r) / 3;
    }
  return f;
}

}  // namespace

TEST_CASE(".flo stores exact values and unknown pixels") {
  const test::TemporaryFolder temporary("flow");
  const auto& folder = temporary.path();
  Flow f = some_flow(7, 5, 0.1F);
  f.u.at(3, 2) = std::nanf("");
  write_flo(folder / "a.flo", f);
  const Flow back = read_flo(folder / "a.flo");
  REQUIRE(back.width() == 7);
  REQUIRE(back.height() == 5);
  for (std::size_t i = 0; i < f.u.px.size(); ++i) {
    const bool known = std::isfinite(f.u.px[i]);
    CHECK(std::isfinite(back.u.px[i]) == known);
    if (known) CHECK((back.u.px[i] == f.u.px[i] && back.v.px[i] == f.v.px[i]));
  }
  // Byte layout: tag, size, then u and v of pixel (0, 0).
  const std::string bytes = read_file(folder / "a.flo");
  CHECK(bytes.substr(0, 4) == "PIEH");
  CHECK(int(bytes[4]) == 7);
  CHECK(int(bytes[8]) == 5);
  CHECK(bytes.size() == 12 + 8 * 35);
  write_file(folder / "cut.flo", bytes.substr(0, 100));
  CHECK_THROWS_AS(read_flo(folder / "cut.flo"), Error);
  write_file(folder / "other.flo", "P5 3 3 255 .........");
  CHECK_THROWS_AS(read_flo(folder / "other.flo"), Error);
  CHECK_THROWS_AS(read_flo(folder / "none.flo"), Error);
}

TEST_CASE("a series of flows round-trips, with times and scale") {
  const test::TemporaryFolder temporary("flow");
  const auto& folder = temporary.path();
  const auto path = folder / "f.h5";
  {
    FlowFileWriter w(path, {31, 18, 15, 0.9164, "{\"type\":\"dis\"}", "film.mp4"});
    for (std::uint64_t k = 0; k < 3; ++k)
      w.write(k + 4, 0.1 * double(k), 0.1 * double(k) + 0.07, some_flow(31, 18, float(k)));
    CHECK(w.size() == 3);
    w.close();
    REQUIRE(FlowFileReader::recognises(path));
    const FlowFileReader r(path);
    CHECK(r.info().width == 31);
    CHECK(r.info().height == 18);
    CHECK(r.info().um_per_px == 0.9164);
    CHECK(r.info().method == "{\"type\":\"dis\"}");
    REQUIRE(r.size() == 3);
    Flow f;
    std::uint64_t frame = 0;
    double t0 = 0, t1 = 0;
    r.read(1, frame, t0, t1, f);
    CHECK(frame == 5);
    CHECK(t0 == 0.1);
    CHECK(t1 == 0.1 + 0.07);
    CHECK(f.u.px == some_flow(31, 18, 1).u.px);
    CHECK(f.v.px == some_flow(31, 18, 1).v.px);
  }
  write_file(folder / "x.h5", "not an HDF5 file");
  CHECK_FALSE(FlowFileReader::recognises(folder / "x.h5"));
  CHECK_THROWS_AS(FlowFileReader(folder / "x.h5"), Error);
}
