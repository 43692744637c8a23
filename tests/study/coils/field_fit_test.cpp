#include "study/coils/field_fit.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

TEST_CASE("the field is evaluated again only for a new shift of the coils") {
  const test::TemporaryFolder folder("fit");
  const std::string coil = "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\n";
  write_file(folder.path() / "drawn.toml", coil + "position = [0, 0, '-30 mm']\n");
  write_file(folder.path() / "real.toml", coil + "gain = 0.9\nposition = ['1 mm', 0, '-29 mm']\n");
  const auto real = read_rig(folder.path() / "real.toml", builtin_parts()).make({});
  std::string table = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (int i = 0; i < 60; ++i) {
    const Vec3 at{1e-3 * (i % 5 - 2), 1e-3 * (i / 5 % 4 - 2), 2e-3 * (i / 20 - 1)};
    const Vec3 b = real->at(at, std::vector<double>{2.0});
    table += fmt::format("{},{},{},{:.17g},{:.17g},{:.17g}\n", at.x, at.y, at.z, b.x, b.y, b.z);
  }
  write_file(folder.path() / "m.csv", table);
  std::uint64_t evaluations = 0;
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv",
                                 {.evaluated = [&](std::uint64_t n) { CHECK(n == ++evaluations); }});
  CHECK(fit.best.gain == doctest::Approx(0.9).epsilon(1e-5));
  CHECK(fit.best.shift[0] == doctest::Approx(1e-3).epsilon(1e-4));
  // Six iterations with the field for a shift and its three derivatives; without reuse there are 55
  // evaluations.
  CHECK(evaluations > 4);
  CHECK(evaluations < 40);
}

TEST_CASE("the axial field along the axis does not determine the lateral position; the rest is fitted") {
  const test::TemporaryFolder folder("fit");
  const std::string coil = "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\n";
  write_file(folder.path() / "drawn.toml", coil);
  write_file(folder.path() / "real.toml", coil + "gain = 0.9\nposition = [0, 0, '3 mm']\n");
  const auto real = read_rig(folder.path() / "real.toml", builtin_parts()).make({});
  std::string table = "x_m,y_m,z_m,bz_t\n";
  for (int i = -15; i <= 15; ++i)
    table +=
        fmt::format("0,0,{},{:.17g}\n", 2e-3 * i, real->at({0, 0, 2e-3 * i}, std::vector<double>{2.0}).z);
  write_file(folder.path() / "m.csv", table);
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv");
  // Across the axis the axial field changes with the square of the distance only.
  for (const char* name : {"shift x", "shift y"})
    CHECK(std::count(fit.undetermined.begin(), fit.undetermined.end(), name) == 1);
  CHECK(fit.undetermined.size() == 2);
  CHECK(fit.best.shift[0] == 0);
  CHECK(std::isnan(fit.standard_error.shift[0]));
  // For an exact model the accuracy of least squares is limited by the forward differences.
  CHECK(fit.best.gain == doctest::Approx(0.9).epsilon(1e-5));
  CHECK(fit.best.shift[2] == doctest::Approx(3e-3).epsilon(1e-4));
}

TEST_CASE(
    "points far from a coil do not determine its gain and its distance separately: the distance is kept") {
  const test::TemporaryFolder folder("fit");
  const std::string coil = "[[coil]]\ntype = 'loop'\nradius = '5 mm'\nturns = 50\ncurrent = 2\n";
  write_file(folder.path() / "drawn.toml", coil);
  const auto real = read_rig(folder.path() / "drawn.toml", builtin_parts()).make({});
  std::string table = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (int i = 0; i < 12; ++i) {
    const Vec3 at{0, 0, 0.2 + 1e-4 * i};
    const Vec3 b = 0.8 * real->at(at, std::vector<double>{2.0});
    const double noise = 2e-10 * (i % 5 - 2);
    table +=
        fmt::format("0,0,{:.17g},{:.17g},{:.17g},{:.17g}\n", at.z, b.x + noise, b.y - noise, b.z + noise);
  }
  write_file(folder.path() / "m.csv", table);
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv");
  CHECK(std::count(fit.undetermined.begin(), fit.undetermined.end(), "shift z") == 1);
  CHECK(std::fabs(fit.best.gain) < 10);
  CHECK(quality_of(fit.warnings) != Quality::good);
}
