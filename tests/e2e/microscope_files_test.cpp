// Files of microscopes from the command line: the pixel size and the frame rate of their metadata, and their
// colours.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "tests/e2e/program.h"
#include "tests/vision/raw_files.h"
#include "tests/vision/ruler_pictures.h"
#include "vision/files/picture.h"

using namespace faba;

namespace {

constexpr int kWidth = 240, kHeight = 160, kPages = 12;

/// Grey of a dark drop of 60 px radius, with noise.
int drop_grey(int x, int y) {
  const double depth = 60 - std::hypot(x - 130, y - 80);
  return int(150 - 60 / (1 + std::exp(-depth))) + (x * 7 + y * 13 + x * y) % 5;
}

/// A TIFF of grey pages with the given metadata; `grey(x, y, page)`.
template <class Grey>
void write_tiff(const std::filesystem::path& file, const std::string& description, double px_per_unit,
                int pages, const Grey& grey) {
  media::TiffPage page;
  page.width = kWidth;
  page.height = kHeight;
  page.description = description;
  page.x_resolution = page.y_resolution = px_per_unit;
  std::vector<media::TiffPage> all;
  for (int k = 0; k < pages; ++k) {
    page.pixels.clear();
    for (int i = 0; i < kWidth * kHeight; ++i) page.pixels += char(grey(i % kWidth, i / kWidth, k));
    all.push_back(page);
  }
  write_file(file, media::tiff_file(all));
}

/// Dark spots in rows; every row moves to the right by 3 px per page.
int swimming_grey(int x, int y, int page) {
  const double dx = std::remainder(x - 3 * page - 20, 40), dy = std::remainder(y - 20, 40);
  return 180 - int(90 * std::exp(-(dx * dx + dy * dy) / 8)) + (x * 7 + y * 13 + x * y * (page + 1)) % 3;
}

struct Metadata {
  std::string name, description;
  double px_per_unit;
  nlohmann::json um_per_px, source;
};

/// Both formats, and a TIFF with only the resolution of a print, which does not give a scale.
const std::vector<Metadata> kFiles = {
    {"ome.tif",
     "<?xml version=\"1.0\"?><OME><Image ID='a'><Pixels PhysicalSizeX='650' PhysicalSizeXUnit='nm' "
     "PhysicalSizeY='650' PhysicalSizeYUnit='nm' TimeIncrement='50' TimeIncrementUnit='ms'/></Image></OME>",
     72, 0.65, "metadata"},
    {"imagej.tif", "ImageJ=1.54f\nimages=12\nunit=um\nfinterval=0.05\n", 2, 0.5, "metadata"},
    {"bare.tif", "", 72, nullptr, nullptr},
};

void check_scale(const nlohmann::json& j, const Metadata& m) {
  CAPTURE(m.name);
  const nlohmann::json um_per_px = j.value("um_per_px", nlohmann::json("absent"));
  CHECK(um_per_px.type() == m.um_per_px.type());
  if (um_per_px.is_number() && m.um_per_px.is_number())
    CHECK(um_per_px.get<double>() == doctest::Approx(m.um_per_px.get<double>()));
  CHECK(j.value("um_per_px_source", nlohmann::json("absent")) == m.source);
}

bool reddish(const Rgb& p) { return p.r > p.g + 40 && p.r > p.b + 40; }

/// A picture in shades of red.
RgbImage reddened(const Gray8& grey) {
  RgbImage out(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.px.size(); ++i)
    out.px[i] = {grey.px[i], std::uint8_t(grey.px[i] / 3), std::uint8_t(grey.px[i] / 3)};
  return out;
}

double red_fraction(const std::filesystem::path& file) {
  const RgbImage picture = read_displayed(file);
  double red = 0;
  for (const Rgb& p : picture.px) red += reddish(p);
  return red / double(picture.px.size());
}

}  // namespace

TEST_CASE("the pixel size of OME-TIFF and ImageJ TIFF is used by drop and by a run on the picture") {
  const TestFolder f;
  write_file(f.path / "s.toml", "duration = '0.2 s'\n[[swarm]]\ncount = 5\nmodel = 'basic'\n");
  for (const Metadata& m : kFiles) {
    write_tiff(f.path / m.name, m.description, m.px_per_unit, 1,
               [](int x, int y, int) { return drop_grey(x, y); });
    check_scale(json_in(f.path, "drop " + m.name), m);
    const Called run =
        faba_in(f.path, "run s.toml --from-video " + m.name + " --seed 1 --force --out run -q");
    REQUIRE_MESSAGE(run.exit == 0, run.err);
    check_scale(nlohmann::json::parse(read_file(f.path / "run/manifest.json")), m);
  }
}

TEST_CASE("the pixel size and the frame interval of OME-TIFF and ImageJ TIFF are used by track") {
  const TestFolder f;
  for (const Metadata& m : kFiles) {
    write_tiff(f.path / m.name, m.description, m.px_per_unit, kPages, swimming_grey);
    const bool stated = !m.um_per_px.is_null();
    const auto j = json_in(f.path, "track " + m.name + (stated ? "" : " --fps 20"));
    check_scale(j, m);
    CHECK(j["frame_s"].get<double>() == doctest::Approx(0.05));
    REQUIRE(j["speed"].is_object());
    CHECK(j["speed"]["mean_px_s"].get<double>() == doctest::Approx(60).epsilon(0.03));
    CHECK(j["speed"].contains("mean_um_s") == stated);
    if (stated)
      CHECK(j["speed"].value("mean_um_s", 0.0) ==
            doctest::Approx(60 * m.um_per_px.get<double>()).epsilon(0.03));
  }
}

TEST_CASE("overlays of a coloured picture have its colours") {
  const TestFolder f;
  Gray8 drop(kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i)
    drop.px[std::size_t(i)] = std::uint8_t(drop_grey(i % kWidth, i / kWidth));
  write_png(f.path / "drop.png", reddened(drop));
  REQUIRE(faba_in(f.path, "drop drop.png --overlay edge.png -q").exit == 0);
  CHECK(red_fraction(f.path / "edge.png") > 0.9);

  RulerScene s;
  s.width = 420;
  s.height = 300;
  s.middle = {200, 150};
  write_png(f.path / "ruler.png", reddened(stretched(render(s), 0, 1)));
  REQUIRE(faba_in(f.path, "scale ruler.png --tick '10 um' --overlay marks.png -q").exit == 0);
  CHECK(red_fraction(f.path / "marks.png") > 0.5);
  // A grey picture has no colours but those of the overlay.
  write_png(f.path / "grey.png", drop);
  REQUIRE(faba_in(f.path, "drop grey.png --overlay edge-grey.png -q").exit == 0);
  CHECK(red_fraction(f.path / "edge-grey.png") < 0.1);
}
