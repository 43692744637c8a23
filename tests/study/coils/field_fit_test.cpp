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
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv", {}, {},
                                 [&](std::uint64_t n) { CHECK(n == ++evaluations); });
  CHECK(fit.best.gain == doctest::Approx(0.9).epsilon(1e-5));
  CHECK(fit.best.shift[0] == doctest::Approx(1e-3).epsilon(1e-4));
  // Six iterations with the field for a shift and its three derivatives; without reuse there are 55
  // evaluations.
  CHECK(evaluations > 4);
  CHECK(evaluations < 40);
}

TEST_CASE("a scan along the axis does not determine the lateral position, and the rest is fitted") {
  const test::TemporaryFolder folder("fit");
  const std::string coil = "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\n";
  write_file(folder.path() / "drawn.toml", coil);
  write_file(folder.path() / "real.toml", coil + "gain = 0.9\nposition = [0, 0, '3 mm']\n");
  const auto real = read_rig(folder.path() / "real.toml", builtin_parts()).make({});
  std::string table = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (int i = -15; i <= 15; ++i) {
    const Vec3 b = real->at({0, 0, 2e-3 * i}, std::vector<double>{2.0});
    table += fmt::format("0,0,{},{:.17g},{:.17g},{:.17g}\n", 2e-3 * i, b.x, b.y, b.z + 1e-7 * (i % 3));
  }
  write_file(folder.path() / "m.csv", table);
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv", {}, {});
  CHECK(fit.best.gain == doctest::Approx(0.9).epsilon(1e-3));
  CHECK(fit.best.shift[2] == doctest::Approx(3e-3).epsilon(1e-2));
  // Across the axis the field changes with the square of the distance only.
  for (const char* name : {"shift x", "shift y"}) {
    CAPTURE(name);
    CHECK(std::count(fit.undetermined.begin(), fit.undetermined.end(), name) <= 1);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const bool fixed = std::isnan(fit.standard_error.shift[k]);
    CHECK((fixed || fit.standard_error.shift[k] < 0.5 * 30e-3));
    CHECK(std::fabs(fit.best.shift[k]) < 5e-3);
  }
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
  const FieldFit fit = field_fit(folder.path() / "drawn.toml", folder.path() / "m.csv", {}, {});
  CHECK(std::count(fit.undetermined.begin(), fit.undetermined.end(), "shift z") == 1);
  CHECK(std::fabs(fit.best.gain) < 10);
  CHECK(quality_of(fit.warnings) != Quality::good);
}
