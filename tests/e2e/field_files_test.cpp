// `faba field fit` and `faba field library`, measured maps in coil systems and libraries in scenarios.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "app/files/library_file.h"
#include "tests/e2e/refused.h"

using namespace faba;

namespace {

const std::string kRigs = FABA_SCENES "/../rigs/";

}  // namespace

TEST_CASE("field fit: finds position and strength of a coil, and the fitted coil system has no residual") {
  const TestFolder f;
  const std::string coil = "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\n";
  write_file(f.path / "drawn.toml", coil + "position = [0, 0, '-30 mm']\n");
  write_file(
      f.path / "real.toml",
      coil + "gain = 0.9\nposition = ['1 mm', '-0.5 mm', '-28 mm']\n[earth]\nfield = ['5 uT', 0, '-9 uT']\n");
  std::string points = "x_m,y_m,z_m\n";
  for (int i = 0; i < 60; ++i)
    points += fmt::format("{},{},{}\n", 1e-3 * (i % 5 - 2), 1e-3 * (i / 5 % 4 - 2), 2e-3 * (i / 20 - 1));
  write_file(f.path / "p.csv", points);
  write_file(f.path / "m.csv", faba_in(f.path, "field at real.toml --points p.csv").out);
  const Called c =
      faba_in(f.path, "field fit drawn.toml --map m.csv --out fitted.toml --picture left.svg --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  // For an exact model the accuracy of least squares is limited by the forward differences.
  CHECK(j["gain"].get<double>() == doctest::Approx(0.9).epsilon(1e-5));
  CHECK(j["shift_m"][0].get<double>() == doctest::Approx(1e-3).epsilon(1e-5));
  CHECK(j["shift_m"][1].get<double>() == doctest::Approx(-0.5e-3).epsilon(1e-5));
  CHECK(j["shift_m"][2].get<double>() == doctest::Approx(2e-3).epsilon(1e-5));
  CHECK(j["offset_t"][0].get<double>() == doctest::Approx(5e-6).epsilon(1e-4));
  CHECK(j["offset_t"][2].get<double>() == doctest::Approx(-9e-6).epsilon(1e-4));
  CHECK(read_file(f.path / "left.svg").find("<svg") != std::string::npos);
  const auto again = faba_in(f.path, "field fit fitted.toml --map m.csv --json").json();
  CHECK(again["gain"].get<double>() == doctest::Approx(1).epsilon(1e-6));
  CHECK(again["rms_t"].get<double>() < 1e-6 * again["rms_field_t"].get<double>());

  refused(f, "field fit drawn.toml --map m.csv --out fitted.toml", 2, "already exists");
  refused(f, "field fit drawn.toml --map m.csv --out m.csv --force", 2, "is an input of this command");
  refused(f, "field fit drawn.toml --map m.csv --out ./drawn.toml --force", 2, "is an input of this command");
  refused(f, "field map drawn.toml --picture /dev/null --force", 2, "is not a regular file");
  refused(f, "field map drawn.toml --current 1e300 --picture m.png", 2, "out of range");
  refused(f, "field fit drawn.toml --map nothing.csv", 3, "nothing.csv: file not found; check the name");
  refused(f, "field fit drawn.toml --map nothing.h5", 3, "nothing.h5: file not found; check the name");
  write_file(f.path / "text.h5", "no HDF5 file");
  refused(f, "field fit drawn.toml --map text.h5", 3, "text.h5: cannot be opened as an HDF5 file");
  refused(f, "field fit drawn.toml --map m.csv --out fitted.csv", 2, "the file extension must be .toml");
  refused(f, "field fit '" + kRigs + "thesis-four-coils.toml' --map m.csv", 2, "all currents are zero");
  write_file(f.path / "few.csv", "x_mm,y_mm,z_mm,bz_mt\n0,0,0,1\n0,0,1,1.1\n");
  refused(f, "field fit drawn.toml --map few.csv", 3, "2 values for 5 parameters");
  std::string one_place = "x_mm,y_mm,z_mm,bz_mt\n";
  for (int i = 0; i < 20; ++i) one_place += "0,0,0,1\n";
  write_file(f.path / "one.csv", one_place);
  refused(f, "field fit drawn.toml --map one.csv", 3, "does not determine");
  write_file(f.path / "no-field.csv", "x_mm,y_mm,z_mm\n0,0,0\n");
  refused(f, "field fit drawn.toml --map no-field.csv", 3, "has no column for the field");
  write_file(f.path / "hole.csv", "x_mm,bz_mt\n0,\n");
  refused(f, "field fit drawn.toml --map hole.csv", 3, "hole.csv:2");
}

TEST_CASE("a map is a coil: from a file of `field map`, relative to the coil system, stored in the run") {
  const TestFolder f;
  std::filesystem::create_directory(f.path / "rigs");
  const std::string two = "'" + kRigs + "thesis-two-coils.toml'";
  for (const auto& [name, current] : {std::pair{"right", "1,0"}, std::pair{"left", "0,1"}})
    REQUIRE(
        faba_in(f.path,
                fmt::format("field map {} --current {} --size '5 mm, 5 mm' --picture {}.png --out rigs/{}.h5",
                            two, current, name, name))
            .exit == 0);
  write_file(f.path / "rigs/maps.toml",
             "[[coil]]\ntype = 'map'\nname = 'right'\nfile = 'right.h5'\nmax_current = 0.5\n"
             "[[coil]]\ntype = 'map'\nname = 'left'\nfile = 'left.h5'\nmax_current = 0.5\n");
  const auto exact = faba_in(f.path, "field null " + two + " --at '0.5 mm, 0 mm' --json").json();
  const auto map = faba_in(f.path, "field null rigs/maps.toml --at '0.5 mm, 0 mm' --json").json();
  for (const std::size_t k : {0, 1}) {
    CHECK(map["currents_a"][k].get<double>() ==
          doctest::Approx(exact["currents_a"][k].get<double>()).epsilon(1e-5));
    CHECK(map["eigenvalues_t_per_m"][k].get<double>() ==
          doctest::Approx(exact["eigenvalues_t_per_m"][k].get<double>()).epsilon(1e-4));
  }
  write_file(
      f.path / "s.toml",
      "duration = '1 s'\n[field]\ntype = 'rig'\nfile = 'rigs/maps.toml'\n[arena]\ntype = 'drop'\nradius_px = "
      "400\n[[swarm]]\ncount = 20\nmodel = 'dipole'\n");
  const Called run = faba_in(f.path, "run s.toml --seed 1 --out run --json");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  std::filesystem::remove_all(f.path / "rigs");
  const Called again = faba_in(f.path, "run run/scenario.toml --out again --json");
  REQUIRE_MESSAGE(again.exit == 0, again.err);
  CHECK(again.json()["state_hash"] == run.json()["state_hash"]);

  write_file(f.path / "bad.csv", "x_mm,y_mm,bx_mt\n0,0,1\n");
  write_file(f.path / "bad.toml", "[[coil]]\ntype = 'map'\nfile = 'bad.csv'\n");
  refused(f, "field null bad.toml", 3, "a map needs the columns x, y, bx and by");
  write_file(f.path / "none.toml", "[[coil]]\ntype = 'map'\nfile = 'none.csv'\n");
  refused(f, "field null none.toml", 3, "none.csv");
  write_file(f.path / "empty.toml", "[[coil]]\ntype = 'map'\n");
  refused(f, "field null empty.toml", 2, "key \"file\" is missing");
}

TEST_CASE("a library in a scenario: the run uses its currents, and wrong libraries are refused") {
  const TestFolder f;
  const std::string four = "'" + kRigs + "thesis-four-coils.toml'";
  const auto made =
      faba_in(f.path, "field library " + four + " --levels 12 --spacing '50 um' --out l.h5 --json");
  REQUIRE_MESSAGE(made.exit == 0, made.err);
  CHECK(made.json()["entries"].get<int>() > 20);
  CHECK(made.json()["null_error_m"]["largest"].get<double>() < 1e-3);
  const std::string scene =
      "duration = '2 s'\n[scale]\num_per_px = 3\n[field]\ntype = 'rig'\nfile = " + four +
      "\n[arena]\ntype = 'drop'\nradius_px = 300\n[[swarm]]\ncount = 20\nmodel = 'dipole'\n"
      "[reference]\ntype = 'hold'\nsetpoint_px = [340, 260]\n";
  write_file(f.path / "s.toml",
             scene + "[library]\nfile = 'l.h5'\n[controller]\ntype = 'gradient'\nsource = 'library'\n");
  const Called run = faba_in(f.path, "run s.toml --seed 1 --out run --json");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  const auto solved =
      faba_in(f.path, "run s.toml --seed 1 --out solved --set controller.source=solve --json");
  REQUIRE(solved.exit == 0);
  CHECK(solved.json()["state_hash"] != run.json()["state_hash"]);
  // scenario.toml of the run finds its library from any folder, and a different library in its place is
  // refused.
  std::filesystem::create_directory(f.path / "elsewhere");
  const Called again = faba_in(f.path / "elsewhere", "run ../run/scenario.toml --out again --json");
  REQUIRE_MESSAGE(again.exit == 0, again.err);
  CHECK(again.json()["state_hash"] == run.json()["state_hash"]);

  refused(f, "field library " + four + " --levels 12 --out l.h5", 2, "already exists");
  refused(f, "field library " + four + " --out l.csv", 2, "the file extension must be .h5 or .hdf5");
  for (const char* spacing : {"0", "0 um", "-1 um"})
    refused(f, "field library " + four + " --out none.h5 --spacing '" + spacing + "'", 2,
            "--spacing: \"" + std::string(spacing) + "\" is out of range; it must be positive");
  refused(f, "run s.toml --seed 1 --out bad --set arena.radius_px=700", 2, "the library covers 2 x 2 mm");
  refused(f, "run s.toml --seed 1 --out bad --set field.file=" + kRigs + "thesis-two-coils.toml", 3,
          "a different coil system");
  refused(f, "run s.toml --seed 1 --out bad --set controller.earth=false", 2, "earth");
  write_file(f.path / "no-library.toml", scene + "[controller]\ntype = 'gradient'\nsource = 'library'\n");
  refused(f, "run no-library.toml --seed 1 --out bad", 2, "needs a library file");
  write_file(f.path / "cut.h5", read_file(f.path / "l.h5").substr(0, 20000));
  refused(f, "run s.toml --seed 1 --out bad --set library.file=cut.h5", 3, "not a complete field library");
  refused(f, "run s.toml --seed 1 --out bad --set library.file=s.toml", 3, "not a complete field library");
  refused(f, "run s.toml --seed 1 --out bad --set library.file=none.h5", 3,
          "file not found; create it with `faba field library");
  REQUIRE(faba_in(f.path, "field library " + four + " --levels 11 --out l.h5 --force -q").exit == 0);
  refused(f, "run run/scenario.toml --out bad", 3, "is not the library with which");
  CHECK_FALSE(std::filesystem::exists(f.path / "bad"));
}

TEST_CASE(
    "kill -9 at any time while a library is built: the same command resumes, and the library is the same") {
  const TestFolder f;
  const std::string build = "field library '" + kRigs + "thesis-four-coils.toml' --levels 12 --quiet --out ";
  REQUIRE(faba_in(f.path, build + "complete.h5").exit == 0);
  const auto complete_file = open_library(f.path / "complete.h5");
  const FieldLibrary& complete = *complete_file;
  for (int kill = 1; kill <= 6; ++kill) {
    const std::string name = "cut" + std::to_string(kill) + ".h5", after = std::to_string(0.05 * kill);
    for (int i = 0; i < 2; ++i) faba_in(f.path, build + name, "timeout -s KILL " + after);
    Called c;
    if (!std::filesystem::exists(f.path / name)) c = faba_in(f.path, build + name, "timeout 900");
    INFO("killed after ", after, " s: ", c.err);
    REQUIRE(std::filesystem::exists(f.path / name));
    const auto resumed_file = open_library(f.path / name);
    const FieldLibrary& resumed = *resumed_file;
    REQUIRE(resumed.entries().size() == complete.entries().size());
    for (std::size_t i = 0; i < resumed.entries().size(); ++i) {
      CHECK(resumed.entries()[i].current == complete.entries()[i].current);
      CHECK(resumed.entries()[i].zero == complete.entries()[i].zero);
    }
    CHECK(resumed.field(0) == complete.field(0));
  }
}
