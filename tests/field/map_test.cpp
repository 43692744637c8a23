// Measured fields: files, the fit of solid harmonics, and invalid input (theory C7).
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <random>

#include "field/field_data.h"
#include "field/harmonics.h"
#include "tests/field/field_of.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

const std::string kCoil =
    "type = 'solenoid'\nradius = 0.005\nlength = 0.04\nturns = 400\nposition = [0.03, 0.018, 0.004]\n"
    "axis = [-1, -0.6, 0.1]\n";

/// The field of the coil for 2 A as a file: `layers` planes of n x n points with a spacing of 1 mm.
struct Sampled {
  test::TemporaryFolder dir{"map"};
  std::string file = (dir.path() / "map.csv").string();
  Sampled(int n, int layers, double noise, const std::string& header = "x_mm,y_mm,z_mm,bx_mt,by_mt,bz_mt") {
    const auto coil = field_of(kCoil);
    std::ofstream out(file);
    out << header << "\n";
    std::mt19937_64 random(3);
    std::normal_distribution<> g(0, noise);
    for (int k = 0; k < layers; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const Vec3 p{1e-3 * (i - n / 2), 1e-3 * (j - n / 2), 1e-3 * (k - layers / 2)};
          Vec3 b;
          coil->per_ampere(0, {&p, 1}, {&b, 1});
          out << fmt::format("{},{},{},{},{},{}\n", p.x * 1e3, p.y * 1e3, p.z * 1e3, 2e3 * b.x + g(random),
                             2e3 * b.y + g(random), 2e3 * b.z + g(random));
        }
  }
  std::string toml(const std::string& more = "") const {
    return fmt::format("type = 'map'\nfile = '{}'\nmeasured_current = 2\n{}", file, more);
  }
};

struct Off {
  double worst = 0, rms = 0;  // fraction of the field; T/A
};
/// Difference between a map and the coil within a box.
Off off(const Field& map, double size, double depth) {
  const auto coil = field_of(kCoil);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<> u(-1, 1);
  Off o;
  constexpr int kPoints = 1000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p{size * u(random), size * u(random), depth * u(random)};
    Vec3 a, b;
    coil->per_ampere(0, {&p, 1}, {&a, 1});
    map.per_ampere(0, {&p, 1}, {&b, 1});
    const double d = norm(a - b);
    o.worst = std::max(o.worst, d / norm(a));
    o.rms += d * d / kPoints;
  }
  o.rms = std::sqrt(o.rms);
  return o;
}

}  // namespace

TEST_CASE("a map reproduces the coil, from a box of points and from one plane") {
  // The error of the series about the centre decreases with the powers of r / d, and that of least squares is
  // not larger: d is the distance of the rim, 20 mm along and 5 mm beside the axis from the centre of the
  // coil.
  const double d = std::sqrt(std::pow(norm({0.03, 0.018, 0.004}) - 0.02, 2) + 0.005 * 0.005);
  for (const int layers : {11, 1}) {
    const Sampled s(11, layers, 0);
    const double depth = layers == 1 ? 0 : 5e-3, r = norm({5e-3, 5e-3, depth});
    const int degree = fit_harmonics(field_data(read_table(s.file))).field.degree();
    INFO(layers, " layers, degree ", degree);
    CHECK(degree >= 12);
    CHECK(off(*field_of(s.toml()), 5e-3, depth).worst < std::pow(r / d, degree));
  }
}

TEST_CASE("noise is smoothed, and the residual gives its standard deviation") {
  const Sampled noisy(11, 5, 0.002);  // mT, for 2 A
  const HarmonicFit fit = fit_harmonics(field_data(read_table(noisy.file)));
  // For N values with noise s the residual of a fit of P coefficients is s sqrt(1 - P / N) with a relative
  // error of 1 / sqrt(2 N); the error of the fit is s sqrt(P / N) rms over the points, and less in the
  // inside.
  const double n = 3.0 * 11 * 11 * 5, p = double(fit.field.coefficients.size()), s = 2e-6;
  CHECK(p < 0.1 * n);
  CHECK(fit.rms == doctest::Approx(s * std::sqrt(1 - p / n)).epsilon(4 / std::sqrt(2 * n)));
  CHECK(off(*field_of(noisy.toml()), 5e-3, 2e-3).rms < 0.5 * std::sqrt(3.0) * s * std::sqrt(p / n));
}

TEST_CASE("the first three coefficients are the field at the centre") {
  const Harmonics h{{1e-3, 2e-3, 3e-3}, 2e-3, {0.3, 0.1, 0.2, 5, 6, 7, 8, 9}};
  const Vec3 b = h.at(h.centre);
  CHECK(b.z == doctest::Approx(0.3));
  CHECK(b.x == doctest::Approx(0.1));
  CHECK(b.y == doctest::Approx(0.2));
}

TEST_CASE("without bz and z the field is assumed symmetric about the plane") {
  const auto rig = field_of(
      "type = 'solenoid'\nradius = 0.005\nlength = 0.04\nposition = [0.045, 0, 0]\naxis = [-1, 0, 0]\n");
  test::TemporaryFolder dir{"map"};
  const auto file = dir.path() / "plane.csv";
  {
    std::ofstream out(file);
    out << "x_cm,y_cm,bx_gauss,by_gauss\n";
    for (int j = -5; j <= 5; ++j)
      for (int i = -5; i <= 5; ++i) {
        const Vec3 p{1e-3 * i, 1e-3 * j, 0};
        Vec3 b;
        rig->per_ampere(0, {&p, 1}, {&b, 1});
        out << fmt::format("{},{},{},{}\n", 0.1 * i, 0.1 * j, 1e4 * b.x, 1e4 * b.y);
      }
  }
  const auto map = field_of(fmt::format("type = 'map'\nfile = '{}'\n", file.string()));
  const Vec3 p{2e-3, -1e-3, 0.4e-3};
  Vec3 a, b;
  rig->per_ampere(0, {&p, 1}, {&a, 1});
  map->per_ampere(0, {&p, 1}, {&b, 1});
  CHECK(norm(a - b) < 1e-5 * norm(a));  // (2.3 mm / 25 mm)^5, the degree is at least 5
}

TEST_CASE("a map moves and rotates with its coil and ends at the edge of the measured box") {
  const Sampled s(11, 3, 0);
  const auto here = field_of(s.toml());
  const auto there = field_of(s.toml("position = ['10 mm', '-4 mm', 0]\nturn = '90 deg'\n"));
  const Vec3 p{1e-3, 2e-3, 0}, q{0.010 - 2e-3, -0.004 + 1e-3, 0}, beyond{0.007, 0, 0};
  Vec3 a, b, c;
  here->per_ampere(0, {&p, 1}, {&a, 1});
  there->per_ampere(0, {&q, 1}, {&b, 1});
  CHECK(b.x == doctest::Approx(-a.y));
  CHECK(b.y == doctest::Approx(a.x));
  here->per_ampere(0, {&beyond, 1}, {&c, 1});
  CHECK(std::isnan(c.x));
  CHECK(here->clearance(beyond) == 0);
}

TEST_CASE("invalid maps are refused with the reason") {
  const auto refused = [](const std::string& toml, const std::string& why) {
    try {
      field_of(toml);
      FAIL("no error for ", toml);
    } catch (const Error& e) {
      INFO(std::string(e.what()));
      CHECK(e.code() == Errc::input);
      CHECK(std::string(e.what()).find(why) != std::string::npos);
    }
  };
  refused(Sampled(7, 3, 0, "x_mm,y_mm,z_mm,bx_mt,bz_mt,by_mt").toml(), "swapped columns");
  refused(Sampled(7, 3, 0, "x_mm,y_mm,z_mm,bx_mt,by_wb,bz_mt").toml(), "column \"by_wb\" has no known unit");
  refused(Sampled(7, 3, 0, "x_mm,y_mm,z_mm,bx_mt,other,bz_mt").toml(), "needs the columns x, y, bx and by");
  refused(Sampled(7, 3, 0, "a,b,c,bx_mt,by_mt,bz_mt").toml(), "has no column for the position");
  refused(Sampled(7, 3, 0).toml("within = '0.5 mm'\n"), "a field needs at least 8");
  refused("type = 'map'\nfile = 'nowhere.csv'\n", "nowhere.csv");
  test::TemporaryFolder dir("map");
  const auto file = (dir.path() / "m.csv").string();
  const auto written = [&](const std::string& b, bool line) {
    std::ofstream out(file);
    out << "x_mm,y_mm,bx_mt,by_mt\n";
    for (int i = 0; i < 30; ++i)
      out << i << "," << (line ? i : i * i % 7) << "," << (i == 5 ? b : "0") << ",0\n";
  };
  const std::string toml = "type = 'map'\nfile = '" + file + "'\n";
  written("1", true);
  refused(toml, "on one line");
  written("0", false);
  refused(toml, "all field values are 0");
  written("1e300", false);
  refused(toml, "out of range");
  written("1", false);
  refused(toml, "is not a magnetic field");
  CHECK_THROWS_AS(field_of("type = 'map'\n"), Error);
  CHECK_THROWS_AS(field_of("type = 'map'\nexpansion = { coefficients = [1, 2] }\n"), Error);
}
