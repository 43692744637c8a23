// `faba field`: output, and messages for wrong input.
#include <doctest/doctest.h>

#include <cmath>

#include "core/h5/h5.h"

#include "tests/e2e/program.h"

using namespace faba;

namespace {

const std::string kRig = "'" FABA_SCENES "/../rigs/thesis-four-coils.toml'";

}  // namespace

TEST_CASE("field at: CSV input and output, 17 digits, currents from the file of the coil system") {
  const TestFolder f;
  std::string rig = read_file(FABA_SCENES "/../rigs/thesis-four-coils.toml");
  for (const auto& [name, amperes] : {std::pair{"right", "-0.25"}, std::pair{"left", "0.25"}}) {
    const std::string line = std::string("name = \"") + name + "\"\n";
    rig.insert(rig.find(line) + line.size(), std::string("current = ") + amperes + "\n");
  }
  write_file(f.path / "rig.toml", rig);
  write_file(f.path / "p.csv", "x_m,y_m,z_m\n0,0,0\n0.002,0.001,0");  // the last line has no line end
  const Called c = faba_in(f.path, "field at rig.toml --points p.csv");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  std::istringstream lines(c.out);
  std::string header, first, second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  CHECK(header == "x_m,y_m,z_m,bx_t,by_t,bz_t");
  double x = 0, y = 0, z = 0, bx = 0, by = 0, bz = 0;
  REQUIRE(std::sscanf(second.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &bx, &by, &bz) == 6);
  // fourcoil_reference.csv, "uniform+x", fourth point, all its digits
  CHECK(bx == doctest::Approx(1.5457058382e-04).epsilon(1e-9));
  CHECK(by == doctest::Approx(-3.6805628574e-06).epsilon(1e-9));
  const auto j = faba_in(f.path, "field at rig.toml --points p.csv --json").json();
  CHECK(j["b_t"][1][0].get<double>() == bx);
  CHECK(j["currents_a"][0].get<double>() == -0.25);
}

TEST_CASE("field null: keys of --json, polarity, an error for a zero that the coils cannot produce") {
  const TestFolder f;
  const auto j = faba_in(f.path, "field null " + kRig + " --at '1 mm, 0 mm' --json").json();
  CHECK(j["currents_a"].size() == 4);
  CHECK(j["eigenvalues_t_per_m"][0].get<double>() < 0);
  CHECK(j["reachable"] == true);
  CHECK(j["saddle"] == false);
  const auto south =
      faba_in(f.path, "field null " + kRig + " --at '1 mm, 0 mm' --polarity south --json").json();
  CHECK(south["currents_a"][0].get<double>() == doctest::Approx(-j["currents_a"][0].get<double>()));
  CHECK(j["note"] == "");
  std::string messages;
  for (const char* verb : {"null", "tolerance"}) {
    const Called c =
        faba_in(f.path, std::string("field ") + verb + " '" FABA_SCENES "/../rigs/helmholtz.toml'");
    INFO(verb, ": ", c.err);
    CHECK(c.exit == 2);
    CHECK(c.out.empty());
    CHECK(c.err.find("cannot produce a zero of the field at (0, 0) mm") != std::string::npos);
    CHECK(c.err.find("or a coil system with more independent coils") != std::string::npos);
    messages = messages.empty() ? c.err : messages;
    CHECK(c.err == messages);
  }
}

TEST_CASE("field null: positions inside a coil and weak gradients give a note") {
  const TestFolder f;
  const auto note = [&](const char* at) {
    return faba_in(f.path, "field null " + kRig + " --at '" + at + "' --json")
        .json()["note"]
        .get<std::string>();
  };
  CHECK(note("20 mm, 0 mm").find("inside the coil \"right\"") != std::string::npos);
  CHECK(note("300 mm, 0 mm")
            .find("too weak to gather cells. Cells with a moment of 1e-15 A m^2 need more than "
                  "4.1 uT to align with the field. The field") != std::string::npos);
  CHECK(note("0 mm, 0 mm").empty());
}

TEST_CASE("field map: zeros, picture, HDF5 file, and error of the table") {
  const TestFolder f;
  const std::string map = "field map " + kRig + " --current 0.5,0.5,0.5,0.5 ";
  const auto j =
      faba_in(f.path, map + "--view '0.6 mm, 0.4 mm' --drop '0.5 mm' --picture m.png --out m.h5 --json")
          .json();
  REQUIRE(j["zeros"].size() == 1);
  CHECK(std::fabs(j["zeros"][0]["at_m"][0].get<double>()) < 1e-12);
  CHECK(j["zeros"][0]["kind"] == "traps north-seekers");
  const std::string text = faba_in(f.path, map + "--check").out;
  CHECK(text.starts_with("zero at (0.0000, 0.0000) mm: traps north-seeking cells, gradients -"));
  CHECK(text.find("maximum interpolation error") != std::string::npos);
  CHECK(j["table"]["error"].get<double>() < 1e-5);
  CHECK(read_file(f.path / "m.png").starts_with("\x89PNG"));
  const H5File h5 = H5File::open(f.path / "m.h5");
  const H5Table b = h5.table("b_t"), x = h5.table("x_m"), y = h5.table("y_m");
  CHECK(b.rows() == y.rows());
  CHECK(b.row_size() == 3 * x.rows());
  std::vector<double> row(b.row_size());
  b.read<double>(0, row);
  double left = 0, top = 0;
  x.read<double>(0, {&left, 1});
  y.read<double>(0, {&top, 1});
  CHECK(left < 0);
  CHECK(top > 0);
  CHECK(row[0] > 0);  // fields point inwards: at the upper left to the right and down
  CHECK(row[1] < 0);
  for (const char* again : {"--picture m.png", "--picture n.png --out m.h5"})
    CHECK(faba_in(f.path, map + again).exit == 2);
  const Called csv = faba_in(f.path, map + "--picture n.png --out n.csv");
  CHECK(csv.exit == 2);
  CHECK(csv.err.find("n.csv: the file extension must be .h5 or .hdf5, not \".csv\"") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(f.path / "n.csv"));
  CHECK(faba_in(f.path, "field map --help").out.find("as PNG; default: field.png") != std::string::npos);
  CHECK(faba_in(f.path, "field map " + kRig + " --check").exit == 0);
  CHECK_FALSE(std::filesystem::exists(f.path / "field.png"));
  CHECK(faba_in(f.path, "field map " + kRig + " --current 0,0,0,0")
            .err.find("such as --current 0.5,0.5,0.5,0.5") != std::string::npos);
  CHECK(faba_in(f.path, "field map " + kRig).err.find("give another name with --picture") !=
        std::string::npos);
  CHECK(faba_in(f.path, "field map none.toml").err.find("none.toml") != std::string::npos);
  for (const char* bad : {"--current 1,2", "--current 1,2,3,x", "--current nan,0,0,0", "--size '1 mm'",
                          "--size '0 mm, 1 mm'", "--view '1 mm'", "--drop '1 s'", "--size '1 s, 1 s'",
                          "--size '6, 4'", "--drop '2 m'", "--check --size '100 mm, 100 mm'"}) {
    const Called c = faba_in(f.path, "field map " + kRig + " " + bad);
    INFO(bad, ": ", c.err);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
  }
}

TEST_CASE("field tolerance: the shifts of theory C6, proportional to their causes") {
  const TestFolder f;
  const std::string two = "'" FABA_SCENES "/../rigs/thesis-two-coils.toml'";
  const auto j = faba_in(f.path, "field tolerance " + two + " --picture t.svg --json").json();
  const auto shift = [&](const std::string& cause, double amount) {
    for (const auto& row : j["rows"])
      if (row["cause"] == cause && row["amount"] == amount) return row["shift_m"].get<double>();
    return -1.0;
  };
  // Theory C6: currents in the ratio 1.1 to 1 shift the zero by 0.364 mm; the worst case is 0.9 to 1, a ratio
  // of 1.111.
  CHECK(shift("current", 10) > 0.364e-3);
  CHECK(shift("current", 10) < 0.364e-3 * 1.13);
  CHECK(shift("earth", 18) ==
        doctest::Approx(18e-6 / 0.0194).epsilon(0.01));  // across, where the gradient is weaker
  for (const char* cause : {"along", "across"})
    CHECK(shift(cause, 0.2) == doctest::Approx(2 * shift(cause, 0.1)).epsilon(0.01));
  CHECK(shift("tilt", 1) == doctest::Approx(2 * shift("tilt", 0.5)).epsilon(0.01));
  CHECK(read_file(f.path / "t.svg").starts_with("<svg"));
  CHECK(faba_in(f.path, "field tolerance " + two + " --picture t.svg").exit == 2);
  CHECK(faba_in(f.path, "field tolerance " + two + " --picture t.png").exit == 2);
  CHECK(faba_in(f.path, "field tolerance " + kRig + " --at '300 mm, 0 mm'")
            .err.find("too weak to gather cells") != std::string::npos);
  const Called table = faba_in(f.path, "field tolerance " + two);
  CHECK(table.err.empty());
  CHECK(table.out.starts_with("deviation from the file                   largest shift of the zero\n"));
  CHECK(faba_in(f.path, "field tolerance " + two + " --at '0 mm, 1 mm'").exit ==
        2);  // two coils have no zero off their axis
}

TEST_CASE("wrong coil systems, points and positions: exit 2 or 3, one line") {
  const TestFolder f;
  const std::string coil = "[[coil]]\ntype = 'solenoid'\n";
  write_file(f.path / "ok.csv", "x_m,y_m,z_m\n0,0,0\n");
  struct Bad {
    const char* what;
    std::string rig, points;
    int exit;
    const char* message;
  };
  for (const Bad& b :
       {Bad{"no coil", "[earth]\nfield = [0, 0, 0]\n", "", 2,
            "is not a coil system file: [[coil]] not found"},
        Bad{"zero turns", coil + "turns = 0\n", "", 2, "out of range"},
        Bad{"NaN current", coil + "current = nan\n", "", 2, "finite"},
        Bad{"no axis", coil + "axis = [0, 0, 0]\n", "", 2, "axis must not be"},
        Bad{"unknown kind", "[[coil]]\ntype = 'selenoid'\n", "", 2, "did you mean \"solenoid\""},
        Bad{"unknown key", coil + "raduis = 1\n", "", 2, "did you mean \"radius\""},
        Bad{"current above its limit", coil + "current = 2\nmax_current = 1\n", "", 2,
            "must not exceed max_current"},
        Bad{"missing column", coil, "x_m,y_m\n0,0\n", 3, "column z_m not found"},
        Bad{"semicolons", coil, "x_m,y_m,z_m\n0;0;0\n", 3, "separate columns with commas"},
        Bad{"no number", coil, "x_m,y_m,z_m\n0,0,zero\n", 3, "is not a number"},
        Bad{"short line", coil, "x_m,y_m,z_m\n0,0\n", 3, "2 fields"},
        Bad{"empty field", coil, "x_m,y_m,z_m\n0,,0\n", 3, "a coordinate is missing"},
        Bad{"no points", coil, "x_m,y_m,z_m\n", 3, "has a header but no points"},
        Bad{"blank file", coil, "\n", 3, "has no name"}}) {
    write_file(f.path / "rig.toml", b.rig);
    write_file(f.path / "p.csv", b.points.empty() ? "x_m,y_m,z_m\n0,0,0\n" : b.points);
    const Called c = faba_in(f.path, "field at rig.toml --points p.csv");
    INFO(b.what, ": ", c.err);
    CHECK(c.exit == b.exit);
    CHECK(one_clear_line(c.err));
    CHECK(c.err.find(b.message) != std::string::npos);
    CHECK(c.out.empty());
  }
  CHECK(faba_in(f.path, "field at missing.toml --points ok.csv").exit == 2);
  write_file(f.path / "rig.toml", coil);
  CHECK(faba_in(f.path, "field at rig.toml --points missing.csv").exit == 3);
  CHECK(faba_in(f.path, "field null rig.toml --at '1, 0'")
            .err.find("\"1\" has no unit; write it like \"1 mm, -0.5 mm\"") != std::string::npos);
  for (const char* at : {"1 mm", "1, 0", "1 s, 0 mm", "one, two", ", ", "nan, 0 mm"}) {
    const Called c = faba_in(f.path, "field null rig.toml --at '" + std::string(at) + "'");
    INFO(at, ": ", c.err);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
  }
}

TEST_CASE("a scenario reads a coil system from a file, and the run stores its content") {
  const TestFolder f;
  std::filesystem::create_directory(f.path / "scenes");
  std::filesystem::copy_file(FABA_SCENES "/../rigs/thesis-four-coils.toml", f.path / "scenes/rig.toml");
  const std::string swarm = "[[swarm]]\ncount = 20\nmodel = 'dipole'\n";
  write_file(f.path / "scenes/s.toml",
             "duration = '1 s'\n[field]\ntype = 'rig'\nfile = 'rig.toml'\n" + swarm);
  const Called c = faba_in(f.path, "run scenes/s.toml --seed 1 --out run --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(read_file(f.path / "run/series.csv").find("current_3_a") != std::string::npos);
  const Called again = faba_in(f.path, "run run/scenario.toml --out again --json");
  REQUIRE_MESSAGE(again.exit == 0, again.err);
  CHECK(again.json()["state_hash"] == c.json()["state_hash"]);

  struct Bad {
    const char* field;
    const char* message;
  };
  for (const Bad& b :
       {Bad{"file = 'none.toml'", "none.toml not found"}, Bad{"file = 3", "expected a string"},
        Bad{"", "add at least one [[coil]]"},
        Bad{"coil = [{ type = 'loop', radius = '1 mm', wire_radius = '1 um' }]", "in the sample plane"},
        Bad{"coil = [{ type = 'loop', radius = '-1 mm' }]", "field.coil[0].radius"}}) {
    write_file(f.path / "bad.toml", "[field]\ntype = 'rig'\n" + std::string(b.field) + "\n" +
                                        "[arena]\ntype = 'drop'\nradius_px = 2000\n" + swarm);
    const Called refused = faba_in(f.path, "run bad.toml --seed 1 --out bad");
    INFO(b.field, ": ", refused.err);
    CHECK(refused.exit == 2);
    CHECK(one_clear_line(refused.err));
    CHECK(refused.err.find(b.message) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(f.path / "bad"));
  }
}

TEST_CASE("field: positions outside a measured map are refused or reported by verbs and runs") {
  const TestFolder f;
  REQUIRE(faba_in(f.path,
                  "field map " + kRig + " --current 1,0,0,0 --size '4 mm, 4 mm' --picture m.png --out m.h5")
              .exit == 0);
  write_file(
      f.path / "maps.toml",
      "[[coil]]\ntype = 'map'\nfile = 'm.h5'\n[[coil]]\ntype = 'map'\nfile = 'm.h5'\nturn = '180 deg'\n");
  for (const char* verb : {"null", "tolerance"}) {
    const Called c = faba_in(f.path, std::string("field ") + verb + " maps.toml --at '10 mm, 0 mm'");
    CHECK(c.exit == 2);
    CHECK(c.err.find("outside a measured map") != std::string::npos);
  }
  const auto partly =
      faba_in(f.path, "field map maps.toml --current 1,1 --size '8 mm, 8 mm' --picture p.png --json").json();
  CHECK(partly["note"].get<std::string>().find("outside a measured map") != std::string::npos);
  CHECK(partly["strongest_t"].get<double>() > 0);
  write_file(f.path / "far.toml",
             "duration = '0.2 s'\n[field]\ntype = 'rig'\nfile = 'maps.toml'\n[[swarm]]\ncount = "
             "5\n[controller]\ntype = "
             "'gradient'\n"
             "[reference]\ntype = 'hold'\nsetpoint_px = [30000, 200]\n");
  const Called far = faba_in(f.path, "run far.toml --out far --json");
  REQUIRE_MESSAGE(far.exit == 0, far.err);
  CHECK(far.err.find("cannot produce a zero of the field at") != std::string::npos);
  // A map can be the only coil of a scenario, without the file of a coil system.
  write_file(f.path / "one.toml",
             "duration = '0.2 s'\n[field]\ntype = 'map'\nfile = 'm.h5'\n[[swarm]]\ncount = 5\n"
             "[controller]\ntype = 'manual'\ncurrent = ['0.1 A']\n[reference]\ntype = 'none'\n");
  const Called one = faba_in(f.path, "run one.toml --out one --json");
  CHECK_MESSAGE(one.exit == 0, one.err);
}

TEST_CASE("field: the same name for two outputs is refused, and positions are limited to 1 m") {
  const TestFolder f;
  CHECK(faba_in(f.path, "field map " + kRig + " --current 1,1,1,1 --picture a.png --out a.png").exit == 2);
  const Called far = faba_in(f.path, "field null " + kRig + " --at '1 km, 0 mm'");
  CHECK(far.exit == 2);
  CHECK(far.err.find("between -1 m and 1 m") != std::string::npos);
}
