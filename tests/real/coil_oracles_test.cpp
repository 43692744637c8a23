// The reference tables of theory C3 and C4, computed with another program and 30 digits. Skipped if they are
// absent.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "field/kernels/axial.h"
#include "tests/skip.h"

using namespace faba;

namespace {

const std::filesystem::path kOracles = std::filesystem::path(FABA_SHARED_DATA) / "../oracles";

// The rows of a CSV file with text in some columns.
struct Rows {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  explicit Rows(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.ends_with('\r')) line.pop_back();
      std::vector<std::string> cells;
      std::istringstream fields(line);
      for (std::string f; std::getline(fields, f, ',');) cells.push_back(f);
      if (names.empty())
        names = cells;
      else
        rows.push_back(cells);
    }
  }
  double at(std::size_t row, const std::string& name) const {
    const auto i = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
    return std::stod(rows.at(row).at(i));
  }
};

}  // namespace

TEST_CASE("solenoid_reference.csv: all rows agree to 1e-10 of the field magnitude") {
  if (test::skipped_without(kOracles / "solenoid_reference.csv")) return;
  const Rows r(read_file(kOracles / "solenoid_reference.csv"));
  REQUIRE(r.rows.size() == 32);
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const double rho = r.at(i, "rho_m"), z = r.at(i, "z_m");
    double b_rho = 0, b_z = 0;
    axial::add_sheet(r.at(i, "radius_m"), r.at(i, "length_m") / 2, 1e-6, r.at(i, "K_A_per_m"),
                     {{&rho, 1}, {&z, 1}}, {{&b_rho, 1}, {&b_z, 1}});
    const double size = std::hypot(b_rho, b_z);
    INFO("row ", i + 1);
    CHECK(std::fabs(b_rho - r.at(i, "Br_T")) < 1e-10 * size);
    CHECK(std::fabs(b_z - r.at(i, "Bz_T")) < 1e-10 * size);
  }
}

TEST_CASE("fourcoil_reference.csv: all rows agree to 1e-10 of the maximum field of one coil at the point") {
  if (test::skipped_without(kOracles / "fourcoil_reference.csv")) return;
  const auto field = read_rig(FABA_SCENES "/../rigs/thesis-four-coils.toml", builtin_parts()).make({});
  const Rows r(read_file(kOracles / "fourcoil_reference.csv"));
  REQUIRE(r.rows.size() == 30);
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const Vec3 at{r.at(i, "x_m"), r.at(i, "y_m"), r.at(i, "z_m")};
    std::vector<double> current;
    double size = 0;
    std::vector<Vec3> b(4);
    field->basis(at, b, {});
    for (std::size_t k = 0; k < 4; ++k) {
      current.push_back(r.at(i, "I" + std::to_string(k)));
      size = std::max(size, std::fabs(current[k]) * std::hypot(b[k].x, b[k].y));
    }
    const Vec3 sum = field->at(at, current);
    INFO("row ", i + 1);
    CHECK(std::fabs(sum.x - r.at(i, "Bx_T")) < 1e-10 * size);
    CHECK(std::fabs(sum.y - r.at(i, "By_T")) < 1e-10 * size);
    CHECK(std::fabs(sum.z - r.at(i, "Bz_T")) < 1e-10 * size);
  }
}
