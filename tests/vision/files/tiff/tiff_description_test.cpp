#include "vision/files/tiff/tiff_description.h"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include "tests/vision/media.h"
#include "tests/vision/raw_files.h"
#include "vision/files/picture_metadata.h"
#include "vision/files/tiff/xml_attributes.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

PictureMetadata ome(const std::string& attributes) {
  return tiff_metadata({"<?xml version=\"1.0\"?><OME><Image ID='a'><Pixels " + attributes +
                            "><Channel/></Pixels></Image></OME>",
                        72, 72},
                       "none.tif");
}

PictureMetadata imagej(const std::string& lines, double x = 2, double y = 2) {
  return tiff_metadata({"ImageJ=1.54f\nimages=3\n" + lines, x, y}, "none.tif");
}

std::string tiff(const std::string& description, int pages, double resolution = 0) {
  media::TiffPage page;
  page.width = 16;
  page.height = 8;
  page.pixels = std::string(128, 'x');
  page.description = description;
  page.x_resolution = page.y_resolution = resolution;
  return media::tiff_file(std::vector<media::TiffPage>(std::size_t(pages), page));
}

}  // namespace

TEST_CASE("OME-XML: pixel size and frame interval in every unit") {
  const auto size = [](const std::string& x, const std::string& unit) {
    return ome(fmt::format("PhysicalSizeX=\"{0}\" PhysicalSizeY=\"{0}\" PhysicalSizeXUnit=\"{1}\" "
                           "PhysicalSizeYUnit=\"{1}\"",
                           x, unit))
        .um_per_px;
  };
  CHECK(size("0.65", "\xC2\xB5m") == 0.65);
  CHECK(size("0.65", "\xCE\xBCm") == 0.65);
  CHECK(size("0.65", "\xB5m") == 0.65);    // Latin-1
  CHECK(size("0.65", "&#xB5;m") == 0.65);  // numeric references
  CHECK(size("0.65", "&#181;m") == 0.65);
  CHECK(*size("650", "nm") == doctest::Approx(0.65));
  CHECK(*size("6.5e-4", "mm") == doctest::Approx(0.65));
  CHECK(ome("PhysicalSizeX='0.65'").um_per_px == 0.65);  // the unit of the schema is um
  CHECK(ome("TimeIncrement='50' TimeIncrementUnit='ms'").fps == doctest::Approx(20));
  CHECK(ome("TimeIncrement='0.05'").fps == doctest::Approx(20));
  CHECK(ome("TimeIncrement='2' TimeIncrementUnit='min'").fps == doctest::Approx(1.0 / 120));
  CHECK_FALSE(ome("SizeX='16'").um_per_px);
  CHECK(ome("SizeX='16'").ignored.empty());
}

TEST_CASE("OME-XML: the first Pixels element counts, not comments, CDATA or other elements") {
  const std::string xml =
      "<!DOCTYPE OME [<!ENTITY a \"<Pixels PhysicalSizeX='9'/>\">]>"
      "<!-- <Pixels PhysicalSizeX='8'/> --><![CDATA[<Pixels PhysicalSizeX='7'/>]]>"
      "<ome:OME xmlns:ome=\"x\"><ome:PixelsOther PhysicalSizeX='6'/>"
      "<ome:Pixels\n  SizeX = \"16\"\n\tPhysicalSizeX = '0.5' PhysicalSizeY=\"0.5\"/>"
      "<ome:Pixels PhysicalSizeX='5'/></ome:OME>";
  CHECK(xml_attributes(xml, "Pixels").at("PhysicalSizeX") == "0.5");
  CHECK(tiff_metadata({xml, 0, 0}, "none.tif").um_per_px == 0.5);
}

TEST_CASE("hostile metadata is ignored, with a reason") {
  for (const char* value : {"NaN", "nan", "inf", "-0.65", "0", "", "0x10", "1e400", "0.65um", "0,65"}) {
    const PictureMetadata m = ome(fmt::format("PhysicalSizeX=\"{}\"", value));
    CHECK_MESSAGE(!m.um_per_px, value);
    CHECK_MESSAGE(m.ignored.find("not a number above 0") != std::string::npos, m.ignored);
    CHECK_MESSAGE(ome(fmt::format("TimeIncrement=\"{}\"", value)).fps == 0, value);
  }
  for (const char* value : {"1e300", "1e-300", "5000"})
    CHECK(ome(fmt::format("PhysicalSizeX=\"{}\"", value)).ignored.find("between 0.001 and 1000") !=
          std::string::npos);
  for (const char* unit : {"inch", "pixel", "reference frame", "", "\xFF\xFE", "furlong"})
    CHECK_FALSE(ome(fmt::format("PhysicalSizeX='0.65' PhysicalSizeXUnit='{}'", unit)).um_per_px);
  CHECK(ome("PhysicalSizeX='0.65' PhysicalSizeY='1.3'").ignored.find("not square") != std::string::npos);
  CHECK(ome("TimeIncrement='1' TimeIncrementUnit='fortnight'").fps == 0);
  const std::string name(100000, 'u');  // a message has at most a part of a value
  CHECK(ome("PhysicalSizeX='1' PhysicalSizeXUnit='" + name + "'").ignored.size() < 200);
}

TEST_CASE("truncated XML and entities: linear time, no expansion") {
  for (const char* text : {"<", "<Pixels", "<Pixels ", "<Pixels PhysicalSizeX", "<Pixels PhysicalSizeX=",
                           "<Pixels PhysicalSizeX='0.5'", "<Pixels PhysicalSizeX=\"0.5", "<!--", "<![CDATA[",
                           "<!DOCTYPE x [", "<Pixels =>", "<Pixels a'='0.5'>", "<?xml", "</Pixels>"})
    CHECK_MESSAGE(!tiff_metadata({text, 0, 0}, "none.tif").um_per_px, text);
  std::string bomb = "<!DOCTYPE x [<!ENTITY e0 \"0.5\">";
  for (int i = 1; i < 30; ++i) bomb += fmt::format("<!ENTITY e{0} \"&e{1};&e{1};\">", i, i - 1);
  bomb += "]><OME><Pixels PhysicalSizeX=\"&e29;\"/></OME>";
  CHECK(xml_attributes(bomb, "Pixels").at("PhysicalSizeX") == "&e29;");
  CHECK_FALSE(tiff_metadata({bomb, 0, 0}, "none.tif").um_per_px);
  std::string many(1 << 20, '<');
  CHECK(xml_attributes(many, "Pixels").empty());
  many.assign(1 << 20, '&');
  CHECK(xml_attributes("<Pixels a='" + many + "'/>", "Pixels").at("a").size() == many.size());
}

TEST_CASE("ImageJ: unit, resolution and frame interval") {
  for (const char* unit : {"um", "micron", "\xC2\xB5m", "\xB5m", "\\u00B5m"})
    CHECK_MESSAGE(imagej(fmt::format("unit={}\n", unit)).um_per_px == 0.5, unit);
  CHECK(imagej("unit=mm\n", 2000, 2000).um_per_px == 0.5);
  CHECK(imagej("unit=um\r\nfinterval=0.25\r\n").um_per_px == 0.5);
  CHECK_FALSE(imagej("").um_per_px);  // a resolution without a unit is that of a print
  CHECK_FALSE(imagej("unit=pixel\n").um_per_px);
  CHECK(imagej("unit=pixel\n").ignored.empty());
  CHECK(imagej("unit=inch\n", 72, 72).ignored.find("print resolution") != std::string::npos);
  CHECK_FALSE(imagej("unit=um\n", 0, 0).um_per_px);
  CHECK_FALSE(imagej("unit=um\n", 2, 3).um_per_px);
  CHECK(imagej("finterval=0.25\nfps=7\n").fps == 4);  // fps is the rate of the playback
  CHECK(imagej("fps=7\n").fps == 7);
  CHECK(imagej("finterval=50\ntunit=ms\n").fps == doctest::Approx(20));
  CHECK(imagej("finterval=nan\n").fps == 0);
  CHECK_FALSE(tiff_metadata({"a scan", 300, 300}, "none.tif").um_per_px);
}

TEST_CASE("files: TIFF stack, companion, picture sequence, and files without metadata") {
  const media::ScratchFolder f;
  media::write_bytes(f / "a.tif", tiff("ImageJ=1.54f\nunit=um\nfinterval=0.1\n", 3, 1.6));
  CHECK(*picture_metadata(f / "a.tif").um_per_px == doctest::Approx(0.625));
  CHECK(VideoReader(f / "a.tif").fps() == doctest::Approx(10));
  CHECK(VideoReader(f / "a.tif", 5).fps() == 5);

  media::write_bytes(f / "b.ome.tif",
                     tiff("<OME><BinaryOnly MetadataFile=\"../../x/set.companion.ome\"/></OME>", 1));
  CHECK_FALSE(picture_metadata(f / "b.ome.tif").um_per_px);
  media::write_bytes(f / "set.companion.ome", "<OME><Pixels PhysicalSizeX='0.4' TimeIncrement='0.5'/></OME>");
  CHECK(picture_metadata(f / "b.ome.tif").um_per_px == 0.4);
  CHECK(VideoReader(f / "b.ome.tif").fps() == 2);
  media::write_bytes(f / "c.tif", tiff("", 1));
  media::write_bytes(f / "c.ome.xml", "<OME><Pixels PhysicalSizeX='0.3'/></OME>");
  CHECK(picture_metadata(f / "c.tif").um_per_px == 0.3);

  std::filesystem::create_directories(f / "series");
  for (int i = 0; i < 3; ++i)
    media::write_bytes(f / fmt::format("series/{}.tif", i),
                       tiff("<OME><Pixels PhysicalSizeX='0.2' TimeIncrement='0.2'/></OME>", 1));
  CHECK(picture_metadata(f / "series").um_per_px == 0.2);
  VideoReader series(f / "series");
  CHECK(series.fps() == doctest::Approx(5));
  GrayF frame;
  double t = 0;
  for (int i = 0; i < 3; ++i) REQUIRE(series.read(frame, t));
  CHECK(t == doctest::Approx(0.4));

  media::write_bytes(f / "bad.tif", "II*");
  std::filesystem::create_directories(f / "empty");
  for (const char* name : {"bad.tif", "empty", "missing.tif", "missing-%d.tif"})
    CHECK_FALSE(picture_metadata(f / name).um_per_px);
}
