// The fit of tables in the forms that people have: units, separators, decimals, shifted axes, no header; and
// of tables that are wrong.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/scenario/rig_file.h"
#include "core/error.h"
#include "core/file.h"
#include "study/coils/field_fit.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

constexpr double kGain = 0.93, kShift = 4e-3, kOffset = 40e-6, kNoise = 2e-6;  // m, T; the truth

/// A coil of 20 mm radius, 50 turns and 2 A as in the file, and the same coil as it is: stronger, shifted
/// along its axis, with a probe whose zero is at kOffset.
struct Scanned {
  explicit Scanned(const std::string& axis = "z") : folder("scan"), axis_(axis) {
    const std::string direction = axis == "z" ? "axis = [0, 0, 1]\n" : "axis = [1, 0, 0]\n";
    const std::string coil =
        "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\n" + direction;
    write_file(folder.path() / "rig.toml", coil);
    write_file(folder.path() / "real.toml", coil + fmt::format("gain = {}\n", kGain));
    real_ = read_rig(folder.path() / "real.toml", builtin_parts());
    field_ = real_.make({});
  }
  /// Measured component along the axis at `along` m from the zero of the ruler, T.
  double reading(double along, double zero_of_ruler = 0) {
    const double s = along - zero_of_ruler - kShift;
    const Vec3 at = axis_ == "z" ? Vec3{0, 0, s} : Vec3{s, 0, 0};
    const Vec3 b = field_->at(at, std::vector<double>{2.0});
    return (axis_ == "z" ? b.z : b.x) + kOffset + noise_(random_);
  }
  FieldFit fit(const std::string& name, const std::string& table, const FieldTableFormat& format = {}) {
    write_file(folder.path() / name, table);
    return field_fit(folder.path() / "rig.toml", folder.path() / name, {.format = format});
  }
  std::string error(const std::string& table, const FieldTableFormat& format = {}) {
    try {
      fit("wrong.csv", table, format);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  test::TemporaryFolder folder;

 private:
  std::string axis_;
  FieldRegistry::PartType real_;
  std::unique_ptr<Field> field_;
  std::mt19937_64 random_{7};
  std::normal_distribution<> noise_{0, kNoise};
};

// The truth is within 4.5 standard errors: outside for 5 tables of 3 parameters once in 10 000.
void check_truth(const FieldFit& fit, std::size_t axis, double zero_of_ruler) {
  constexpr double kErrors = 4.5;
  CHECK(std::fabs(fit.best.gain - kGain) < kErrors * fit.standard_error.gain);
  CHECK(std::fabs(fit.best.shift[axis] - zero_of_ruler - kShift) < kErrors * fit.standard_error.shift[axis]);
  CHECK(std::fabs(fit.best.offset[axis] - kOffset) < kErrors * fit.standard_error.offset[axis]);
  // 40 points of noise 2 uT determine each parameter to a few percent of its unit.
  CHECK(fit.standard_error.gain < 0.02);
  CHECK(fit.standard_error.shift[axis] < 1e-3);
  CHECK(fit.standard_error.offset[axis] < 5e-6);
  std::vector<std::string> across{"shift x", "shift y", "shift z"};
  across.erase(across.begin() + std::ptrdiff_t(axis));
  std::vector<std::string> kept = fit.undetermined;
  std::sort(kept.begin(), kept.end());
  CHECK(kept == across);
  CHECK(quality_of(fit.warnings) == Quality::good);
}

std::string with_commas(std::string number) {
  std::replace(number.begin(), number.end(), '.', ',');
  return number;
}

}  // namespace

TEST_CASE("a scan with semicolons, decimal commas, cm and gauss") {
  Scanned s;
  std::string table = "z (cm);B (G)\r\n";
  for (int i = -20; i <= 20; ++i)
    table += with_commas(fmt::format("{:.2f}", 0.3 * i)) + ";" +
             with_commas(fmt::format("{:.4f}", 1e4 * s.reading(3e-3 * i))) + "\r\n";
  check_truth(s.fit("scan.csv", table), 2, 0);
}

TEST_CASE("a scan with tabs, comments, a text column, and a ruler whose zero is far from the coil") {
  Scanned s;
  std::string table = "# probe 3\nz [mm]\tpoint\tBz [mT]\n";
  for (int i = 0; i <= 40; ++i)
    table += fmt::format("{}\tp{}\t{:.5f}\n{}", 240 + 3 * i, i, 1e3 * s.reading(0.24 + 3e-3 * i, 0.3),
                         i == 20 ? "# pause\n\n" : "");
  check_truth(s.fit("scan.txt", table), 2, 0.3);
}

TEST_CASE("a negative axis in inches, with a line of units") {
  Scanned s("x");
  std::string table = "x,B\ninch,\xC2\xB5T\n";
  for (int i = 0; i <= 40; ++i)
    table +=
        fmt::format("{:.4f},{:.2f}\n", -7.5 + 0.12 * i, 1e6 * s.reading(25.4e-3 * (-7.5 + 0.12 * i), -0.13));
  check_truth(s.fit("scan.csv", table), 0, -0.13);
}

TEST_CASE("without a header: an error with the options that describe the columns, and a fit with them") {
  Scanned s;
  std::string table;
  for (int i = -20; i <= 20; ++i)
    table += fmt::format("{:7.2f}   {:9.4f}\n", 0.3 * i, 1e4 * s.reading(3e-3 * i));
  const std::string reason = s.error(table);
  CHECK(reason.find("--columns z,b --units cm,G") != std::string::npos);
  check_truth(s.fit("scan.dat", table, {.columns = {"z", "b"}, .units = {"cm", "G"}}), 2, 0);
  CHECK(s.error(table, {.columns = {"z"}, .units = {"cm"}}).find("has 2") != std::string::npos);
  CHECK(s.error(table, {.columns = {"z", "q"}, .units = {"cm", "G"}}).find("\"q\" is not a column") !=
        std::string::npos);
  CHECK(s.error(table, {.columns = {"z", "b"}, .units = {"cm", "lb"}}).find("\"lb\" is not a unit") !=
        std::string::npos);
  CHECK(s.error(table, {.columns = {"z", "b"}}).find("no known unit") != std::string::npos);
}

TEST_CASE("a header in a comment, as of gnuplot, and one without units") {
  Scanned s;
  std::string rows;
  for (int i = -20; i <= 20; ++i) rows += fmt::format("{:.1f} {:.5f}\n", 3.0 * i, 1e3 * s.reading(3e-3 * i));
  check_truth(s.fit("scan.dat", "# z (mm) B (mT)\n" + rows), 2, 0);
  CHECK(s.error("z B\n" + rows).find("--units") != std::string::npos);
  check_truth(s.fit("units.dat", "z B\n" + rows, {.columns = {}, .units = {"mT", "mm"}}), 2, 0);
  CHECK(s.error("z_mm B_mT\n" + rows, {.columns = {}, .units = {"cm", "mT"}}).find("differs") !=
        std::string::npos);
  CHECK(s.error("position field\n" + rows).find("--columns") != std::string::npos);
}

TEST_CASE("a scan far from the coil names what it does not determine, and never a gain of -93 +- 502") {
  Scanned s;
  std::string table = "z_mm,b_ut\n";
  for (int i = 0; i <= 40; ++i)
    table += fmt::format("{},{:.3f}\n", 150 + i, 1e6 * s.reading(0.15 + 1e-3 * i));
  const FieldFit fit = s.fit("far.csv", table);
  // A dipole field: gain, size of the coil and distance have nearly the same effect.
  CHECK(std::count(fit.undetermined.begin(), fit.undetermined.end(), "size") +
            std::count(fit.undetermined.begin(), fit.undetermined.end(), "shift z") >=
        1);
  CHECK(quality_of(fit.warnings) != Quality::good);
  CHECK(std::fabs(fit.best.gain) < 10);
}

TEST_CASE("wrong tables give an error, or a poor quality with its reason") {
  Scanned s;
  std::vector<double> z, b;
  for (int i = -20; i <= 20; ++i) {
    z.push_back(3.0 * i);
    b.push_back(1e3 * s.reading(3e-3 * i));
  }
  const auto table = [&](const auto& row) {
    std::string text = "z_mm,b_mt\n";
    for (std::size_t i = 0; i < z.size(); ++i) text += row(z[i], b[i]);
    return text;
  };
  const auto has = [](const FieldFit& fit, const char* aspect) {
    return std::any_of(fit.warnings.begin(), fit.warnings.end(),
                       [&](const Warning& w) { return w.aspect == aspect && w.quality == Quality::poor; });
  };
  const double most = *std::max_element(b.begin(), b.end());
  CHECK(has(s.fit("a.csv", table([&](double x, double y) {
                    return fmt::format("{},{}\n", x, std::min(y, 0.8 * most));
                  })),
            "saturation"));
  CHECK(has(s.fit("b.csv", table([&](double x, double y) { return fmt::format("{},{}\n", x, -y); })),
            "direction"));
  CHECK(has(s.fit("c.csv", table([&](double x, double y) { return fmt::format("{},{}\n", x, 10 * y); })),
            "gain") == false);  // doubtful: a gain of 9.3 may be a wrong number of turns
  CHECK(has(s.fit("d.csv", table([&](double x, double y) { return fmt::format("{},{}\n", x, 1000 * y); })),
            "gain"));
  CHECK(has(s.fit("e.csv",
                  table([&](double x, double y) { return fmt::format("{},{}\n", x, x < 0 ? y : 10 * y); })),
            "residual"));
  CHECK(s.error(table([&](double x, double y) {
           return fmt::format("{},{}\n", 10 * y, x);
         })).find("does not determine") != std::string::npos);  // columns swapped
  CHECK(s.error(table([&](double x, double) {
           return fmt::format("{},1.5\n", x);
         })).find("all values of the field") != std::string::npos);
  CHECK(s.error(table([&](double x, double y) {
           return fmt::format("{},{}\n", 10 * y, std::fabs(x));
         })).find("does not determine") != std::string::npos);
  CHECK(s.error("z_mm,b_mt\n0,1\n").find("parameters") != std::string::npos);
  CHECK(s.error("z_mm,b_mt\n0,1\n1,nan\n").find("csv:3") != std::string::npos);
  CHECK(s.error("z_mm,b_mt\n0,1\n1,high\n").find("\"high\" in column b is not a number") !=
        std::string::npos);
  CHECK(s.error("z_mm,b_mt\n0,1\n1\n").find("csv:3") != std::string::npos);
  CHECK(s.error("z (mm);b (mT)\n0,5;1.5\n1;2\n").find("comma in a number") != std::string::npos);
  CHECK(s.error("z_mm,z_cm,b_mt\n0,1,2\n").find("two columns for z") != std::string::npos);
  CHECK(s.error("x_mm,z_mm,b_mt\n0,1,2\n").find("which component") != std::string::npos);
  CHECK(s.error("z_mm,b_kelvin\n0,1\n").find("no known unit") != std::string::npos);
}

TEST_CASE("a table in a wrong unit: the message names the likely unit and its evidence") {
  struct Case {
    const char *header, *likely;
    double lengths, fields;  // per m, per T
    bool fitted = true;
  };
  for (const Case& c :
       {Case{"z_mm,b_t", "1000 times smaller, as of mT read as T", 1e3, 1e3},
        Case{"z_mm,b_mt", "10 times smaller, as of G read as mT", 1e3, 1e4},
        Case{"z_mm,b_t", "10000 times smaller, as of G read as T", 1e3, 1e4, false},
        Case{"z_mm,b_mt", "1000 times larger, as of T read as mT", 1e3, 1},
        Case{"z_m,b_mt", "lengths are 1000 times smaller, as of mm read as m", 1e3, 1e3},
        Case{"z_mm,b_mt", "lengths are 10 times larger, as of cm read as mm", 1e2, 1e3, false},
        Case{"z_mm,b_mt", "lengths are 25.4 times larger, as of inches read as mm", 1 / 25.4e-3, 1e3,
             false}}) {
    CAPTURE(c.header);
    CAPTURE(c.likely);
    Scanned s;
    std::string table = std::string(c.header) + "\n";
    for (int i = -20; i <= 20; ++i)
      table += fmt::format("{:.8g},{:.8g}\n", 3e-3 * i * c.lengths, s.reading(3e-3 * i) * c.fields);
    std::string message;
    if (c.fitted) {
      const FieldFit fit = s.fit("unit.csv", table);
      CHECK(quality_of(fit.warnings) != Quality::good);
      REQUIRE(!fit.warnings.empty());
      message = sentence(fit.warnings.front());
    } else {
      message = s.error(table);
    }
    INFO(message);
    CHECK(message.find(c.likely) != std::string::npos);
    CHECK(message.find("the gain is 0.93 if") != std::string::npos);
    CHECK(message.find("add points") == std::string::npos);
  }
}
