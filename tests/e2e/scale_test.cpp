// `faba scale`: output, files, and messages for invalid input.
#include <doctest/doctest.h>

#include <string>

#include "tests/e2e/program.h"
#include "tests/vision/ruler_pictures.h"
#include "vision/files/picture.h"

using namespace faba;

namespace {

const std::string kTable = "width_um,px\n30,41\n50,63\n70,88\n200,227\n";

void write_ruler(const std::filesystem::path& file, int marks = 1000) {
  RulerScene s;
  s.width = 420;
  s.height = 300;
  s.middle = {200, 150};
  s.angle_deg = 5;
  s.first = -marks;
  s.last = marks;
  write_png(file, stretched(render(s), 0, 1));
}

}  // namespace

TEST_CASE("scale with a table: text and JSON output, and a calibration file that a scenario reads") {
  const TestFolder f;
  write_file(f.path / "ruler.csv", kTable);
  const Called c = faba_in(f.path, "scale ruler.csv --out calibration.toml");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.out.find("regression") != std::string::npos);
  CHECK(c.out.find("\nmean ratio   ") != std::string::npos);
  CHECK(c.out.find("reading = ") < c.out.find(" px (95 % interval "));
  CHECK(c.out.find("calibration.toml") != std::string::npos);
  const Called again = faba_in(f.path, "scale ruler.csv --json --out calibration.toml");
  CHECK(again.exit == 2);
  CHECK(one_clear_line(again.err));
  const auto j = faba_in(f.path, "scale ruler.csv --json --out calibration.toml --force").json();
  for (const char* key : {"um_per_px", "ratio_mean", "ratio_sd"}) CHECK(j[key].is_number());
  CHECK(j["ci95"].size() == 2);
  write_file(f.path / "s.toml",
             kSmallScene + "[scale]\nfile = 'calibration.toml'\n[record]\nvideo = false\n");
  const Called run = faba_in(f.path, "run s.toml --seed 1 --out r --quiet");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  std::filesystem::remove(f.path / "calibration.toml");
  const std::string resolved = read_file(f.path / "r" / "scenario.toml");
  CHECK(resolved.find("calibration.toml") == std::string::npos);
  CHECK(resolved.find("um_per_px = 0.9") != std::string::npos);
  CHECK(faba_in(f.path, "run r/scenario.toml --seed 1 --out r2 --quiet").exit == 0);
}

TEST_CASE("scale with a picture of a ruler") {
  const TestFolder f;
  write_ruler(f.path / "ruler.png");
  const Called c = faba_in(f.path, "scale ruler.png --tick '10 um' --json --overlay marks.png");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["um_per_px"].get<double>() == doctest::Approx(10 / 12.3).epsilon(1e-3));
  CHECK(std::filesystem::exists(f.path / "marks.png"));
  CHECK(faba_in(f.path, "scale ruler.png --tick '0.01 mm' --json").json()["um_per_px"] ==
        c.json()["um_per_px"]);
  CHECK(faba_in(f.path, "scale ruler.png --tick '10 um' -q").out.empty());
}

TEST_CASE("scale with invalid input: one clear line and the documented exit code") {
  const TestFolder f;
  write_ruler(f.path / "ruler.png");
  write_ruler(f.path / "few.png", 1);
  write_file(f.path / "text.csv", "Dear diary,\ntoday we measured\n\na ruler\n");
  write_file(f.path / "text.png", "not a picture");
  write_file(f.path / "one.csv", "width_um,px_1,px_2,px_3\n30,41,42,40\n");
  write_file(f.path / "minus.csv", "width_um,px\n-30,41\n50,63\n70,88\n");
  write_file(f.path / "nan.csv", "width_um,px\n30,nan\n50,63\n70,88\n");
  write_file(f.path / "empty.csv", "");
  write_file(f.path / "good.csv", kTable);
  write_png(f.path / "black.png", Gray8(320, 240));
  write_png(f.path / "tiny.png", Gray8(3, 2, 100));
  const auto check = [&](const std::string& arguments, int exit) {
    CAPTURE(arguments);
    const Called c = faba_in(f.path, "scale " + arguments);
    CAPTURE(c.err);
    CHECK(c.exit == exit);
    CHECK(one_clear_line(c.err));
    CHECK(c.out.empty());
  };
  for (const char* table : {"text.csv", "one.csv", "minus.csv", "nan.csv", "empty.csv", "absent.csv"})
    check(table + std::string(" --out c.toml"), 3);
  for (const char* picture : {"text.png", "few.png", "black.png", "tiny.png", "absent.png", "."})
    check(picture + std::string(" --tick '10 um' --out c.toml"), 3);
  CHECK(faba_in(f.path, "scale few.png --tick '10 um'").err.find("in view") != std::string::npos);
  for (const char* usage :
       {"ruler.png", "ruler.png --tick ''", "ruler.png --tick 10", "ruler.png --tick '10 s'",
        "ruler.png --tick '-1 um'", "ruler.png --tick '0 um'", "ruler.png --tick 'nan um'",
        "ruler.png --tick '10 um' --overlay ruler.png --force", "good.csv --tick '10 um'",
        "good.csv --overlay o.png", "good.csv --out calibration.json", ""})
    check(usage, 2);
  CHECK_FALSE(std::filesystem::exists(f.path / "c.toml"));
  // The file is checked before the missing option.
  CHECK(faba_in(f.path, "scale text.png").err.find("a table of readings needs the extension .csv") !=
        std::string::npos);
  CHECK(faba_in(f.path, "scale absent.png").err.find("absent.png: file not found") != std::string::npos);
  CHECK(
      faba_in(f.path, "scale ruler.png --tick 10").err.find("\"10\" has no unit; write it like \"10 um\"") !=
      std::string::npos);
  write_file(f.path / "falling.csv", "width_um,px\n100,40\n50,66\n30,81\n20,90\n");
  CHECK(faba_in(f.path, "scale falling.csv").err.find("check that the columns are not exchanged") !=
        std::string::npos);
  write_file(f.path / "three.csv", "width_um,px\n30,40\n50,66\n100,121\n");
  CHECK(faba_in(f.path, "scale three.csv").err.find("the 95 % interval is +- 65 %") != std::string::npos);
  CHECK(faba_in(f.path, "scale good.csv").err.empty());
}
