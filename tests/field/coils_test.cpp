// Coils compared with sums over their wires, with Maxwell's equations and with each other, for random
// geometries (theory C1, C2, C4).
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "field/kernels/axial.h"
#include "field/kernels/field_table.h"
#include "tests/field/field_of.h"
#include "tests/field/wires.h"

using namespace faba;

namespace {

/// Random coils of every kind, and points at 0.1 mm to 0.5 m from their windings.
struct Draw {
  std::mt19937_64 random{7};
  double uniform(double lo, double hi) { return std::uniform_real_distribution<>(lo, hi)(random); }
  double log_uniform(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
  std::string vec(double size) {
    return fmt::format("[{}, {}, {}]", uniform(-size, size), uniform(-size, size), uniform(-size, size));
  }
  std::string coil(const std::string& kind) {
    const double a = log_uniform(1e-3, 0.1);
    if (kind == "map") {
      std::string t =
          fmt::format("type = 'map'\nposition = {}\nturn = {}\n[expansion]\n", vec(a), uniform(-3, 3));
      t += fmt::format("centre = {}\nhalf_size = [{}, {}, {}]\nradius = {}\ncoefficients = [", vec(a / 3), a,
                       a * uniform(0.3, 1), a * uniform(0.3, 1), 1.5 * a);
      const int degree = 1 + int(uniform(0, 13.99));
      for (int i = 0; i < (degree + 1) * (degree + 1) - 1; ++i) t += fmt::format("{}, ", uniform(-1, 1));
      return t + "]\n";
    }
    std::string t = fmt::format("type = '{}'\nposition = {}\naxis = {}\n", kind, vec(a), vec(1));
    if (kind == "dipole") return t + fmt::format("moment = {}\nradius = {}\n", uniform(-1, 1), a / 10);
    if (kind == "thick_coil")
      return t + fmt::format("inner_radius = {}\nouter_radius = {}\nlength = {}\nturns = 300\n", a,
                             a * uniform(1.1, 2), a * uniform(0.3, 4));
    t += fmt::format("radius = {}\nturns = {}\n", a, std::floor(uniform(1, 500)));
    if (kind == "solenoid") t += fmt::format("length = {}\n", a * log_uniform(0.1, 10));
    if (kind == "solenoid" && uniform(0, 1) < 0.5)
      t += fmt::format("core_permeability = {}\ncore_length = {}\n", uniform(1, 20), a * uniform(0.5, 12));
    if (kind == "loop" || kind == "helmholtz") t += fmt::format("wire_radius = {}\n", a / 1000);
    if (kind == "helmholtz" && uniform(0, 1) < 0.5) t += "opposed = true\n";
    return t;
  }
  Vec3 point(const Field& f) {
    for (;;) {
      const double size = log_uniform(1e-3, 0.3);
      const Vec3 p{uniform(-size, size), uniform(-size, size), uniform(-size, size)};
      if (const double d = f.clearance(p); d > 1e-4 && d < 0.5) return p;
    }
  }
};

// The kinds of [[coil]].
FieldRegistry coils() { return engine_parts().field.only(Trait::coil, "coil", ""); }

}  // namespace

TEST_CASE("every coil: no divergence, no curl (C2)") {
  Draw draw;
  for (const auto& kind : coils().names())
    for (int i = 0; i < 40; ++i) {
      const std::string toml = draw.coil(kind);
      const auto f = field_of(toml);
      const Vec3 p = draw.point(*f);
      Vec3 b;
      Mat3 g;
      f->basis(p, {&b, 1}, {&g, 1});
      double size = 0;
      for (const auto& row : g)
        for (const double v : row) size = std::max(size, std::fabs(v));
      INFO(toml, "at ", p.x, " ", p.y, " ", p.z, ", clearance ", f->clearance(p));
      // Differences resolve b / clearance to 1e-10 (Field::basis); C2 requires 1e-7 of the gradient.
      const double allowed = 1e-7 * size + 1e-9 * norm(b) / f->clearance(p);
      CHECK(std::fabs(g[0][0] + g[1][1] + g[2][2]) < allowed);
      CHECK(std::fabs(g[0][1] - g[1][0]) < allowed);
      CHECK(std::fabs(g[0][2] - g[2][0]) < allowed);
      CHECK(std::fabs(g[1][2] - g[2][1]) < allowed);
    }
}

TEST_CASE("three coil systems agree with the sum over their wires to 1e-8") {
  struct Case {
    const char* name;
    std::string toml;
    std::vector<Wire> wires;
  };
  const Vec3 tilted{0.3, -0.5, 0.8};
  const std::vector<Case> cases{
      {"two tilted solenoids",
       "type = 'rig'\n[[coil]]\ntype = 'solenoid'\nradius = 0.008\nlength = 0.03\nturns = 250\nposition = "
       "[0.04, 0.01, 0]\naxis = [-1, 0.2, 0.1]\n[[coil]]\ntype = 'solenoid'\nradius = 0.02\nlength = "
       "0.01\nturns = 80\nposition = [0, -0.05, 0.02]\naxis = [0.3, -0.5, 0.8]\n",
       {sheet({0.04, 0.01, 0}, {-1, 0.2, 0.1}, 0.008, 0.03, 250),
        sheet({0, -0.05, 0.02}, tilted, 0.02, 0.01, 80)}},
      {"a Maxwell pair and a loop",
       "type = 'rig'\n[[coil]]\ntype = 'helmholtz'\nradius = 0.05\nturns = 60\nopposed = true\naxis = [0, 1, "
       "0]\n[[coil]]\ntype = 'loop'\nradius = 0.03\nturns = 12\nposition = [0, 0, -0.02]\n",
       {loops({{0, -0.05 * std::sqrt(3.0) / 2, 0}, {0, 0.05 * std::sqrt(3.0) / 2, 0}}, {0, 1, 0}, 0.05,
              {60, -60}),
        loops({{0, 0, -0.02}}, {0, 0, 1}, 0.03, {12})}},
      {"a thick coil",
       "type = 'rig'\n[[coil]]\ntype = 'thick_coil'\ninner_radius = 0.01\nouter_radius = 0.02\nlength = "
       "0.025\nturns = 900\nposition = [0.06, 0, 0]\naxis = [1, 0, 0]\n",
       {thick({0.06, 0, 0}, {1, 0, 0}, 0.01, 0.02, 0.025, 900)}}};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> u(-0.012, 0.012);
  for (const Case& c : cases) {
    const auto f = field_of(c.toml);
    REQUIRE(f->coils() == c.wires.size());
    for (int i = 0; i < 20; ++i) {
      const Vec3 p{u(random), u(random), u(random)};
      std::vector<Vec3> b(f->coils());
      f->basis(p, b, {});
      for (std::size_t k = 0; k < b.size(); ++k) {
        const Vec3 sum = biot_savart(c.wires[k], p);
        INFO(c.name, ", coil ", k);
        CHECK(norm(b[k] - sum) < 1e-8 * norm(sum));
      }
    }
  }
}

TEST_CASE("the far field of every coil is that of a dipole of moment N I pi a^2, for any shape and pose") {
  Draw draw;
  const double pi = 3.14159265358979;
  for (int i = 0; i < 200; ++i) {
    const double a = draw.log_uniform(1e-3, 0.1), n = draw.uniform(1, 500), l = a * draw.uniform(0.1, 4);
    const double b = a * draw.uniform(1.1, 2), d = a * draw.uniform(0.2, 3);
    struct Case {
      std::string toml;
      double moment, size;  // A m^2 for 1 A, and distance of the furthest wire, m
    };
    const Case cases[] = {
        {fmt::format("type = 'loop'\nradius = {}\nturns = {}\nwire_radius = {}\n", a, n, a / 100),
         n * pi * a * a, a},
        {fmt::format("type = 'solenoid'\nradius = {}\nlength = {}\nturns = {}\n", a, l, n), n * pi * a * a,
         norm(Vec2{a, l / 2})},
        {fmt::format("type = 'helmholtz'\nradius = {}\ndistance = {}\nturns = {}\nwire_radius = {}\n", a, d,
                     n, a / 100),
         2 * n * pi * a * a, norm(Vec2{a, d / 2})},
        {fmt::format("type = 'thick_coil'\ninner_radius = {}\nouter_radius = {}\nlength = {}\nturns = {}\n",
                     a, b, l, n),
         n * pi * (a * a + a * b + b * b) / 3, norm(Vec2{b, l / 2})}};
    const Case& c = cases[i % 4];
    const std::string pose = fmt::format("position = {}\naxis = {}\n", draw.vec(0.1), draw.vec(1));
    const auto coil = field_of(c.toml + pose);
    const auto dipole =
        field_of(fmt::format("type = 'dipole'\nmoment = {:.17g}\nradius = 1e-6\n", c.moment) + pose);
    const Document place = parse_toml(pose, "pose");
    const auto at = [&](int k) { return place.root["position"][std::size_t(k)].get<double>(); };
    const Vec3 middle{at(0), at(1), at(2)};
    Vec3 away{draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    away = (1 / norm(away)) * away;
    double off[2];
    for (int far = 0; far < 2; ++far) {
      Vec3 x, y;
      const Vec3 p = middle + (50 * (far + 1) * c.size) * away;
      coil->basis(p, {&x, 1}, {});
      dipole->basis(p, {&y, 1}, {});
      off[far] = norm(x - y) / norm(y);
    }
    INFO(c.toml, pose);
    // The next multipole is (size / r)^2 of the dipole times at most 6, and falls with the square of r.
    CHECK(off[0] < 6.0 / (50 * 50));
    CHECK(off[1] < 6.0 / (100 * 100));
    if (off[0] > 1e-5) CHECK(off[1] == doctest::Approx(off[0] / 4).epsilon(0.02));
  }
}

TEST_CASE(
    "two formulas for one coil: the axial derivative of a sheet is the field of two loops at its rims") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<> u(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const double a = 0.001 + 0.05 * u(random), half = a * (0.1 + 3 * u(random));
    const double rho = 3 * a * u(random), z = half * (4 * u(random) - 2);
    const double near = std::min(norm(Vec2{rho - a, z - half}), norm(Vec2{rho - a, z + half}));
    if (near < 0.05 * a || std::fabs(rho - a) < 0.05 * a) continue;
    const auto sheet = [&](double at) {
      Vec2 b;
      axial::add_sheet(a, half, 1e-9, 1, {{&rho, 1}, {&at, 1}}, {{&b.x, 1}, {&b.y, 1}});
      return b;
    };
    const auto loop = [&](double at) {
      Vec2 b;
      axial::add_loop(a, 1e-9, 1, {{&rho, 1}, {&at, 1}}, {{&b.x, 1}, {&b.y, 1}});
      return b;
    };
    const double h = 0.01 * std::min(near, std::fabs(rho - a));
    Vec2 slope;
    const double w[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    for (int j = 1; j <= 3; ++j) slope = slope + (w[j - 1] / h) * (sheet(z + j * h) - sheet(z - j * h));
    const Vec2 rims = loop(z + half) - loop(z - half);
    CHECK(norm(slope - rims) < 1e-8 * (norm(rims) + norm(sheet(z)) / near));
  }
}

// The standard library takes k and n, whose complements 1 - k^2 = kc^2 and 1 - n = g^2 have a relative
// precision of about 2e-16 / kc^2 and 2e-16 / g^2.
TEST_CASE("sheets and loops agree with the elliptic integrals of the standard library to 1e-12") {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<> u(0.0, 1.0);
  const double mu0_over_pi = axial::kMu0 / 3.14159265358979323846;
  for (int i = 0; i < 3000; ++i) {
    const double a = 0.01, half = 0.02;
    // Half of the points near a rim, where convergence is slowest.
    const double near = std::pow(10, -4 * u(random)), turn = 6.283185307179586 * u(random);
    const double rho = i % 2 ? 3 * a * u(random) : std::fabs(a + a * near * std::cos(turn));
    const double z = i % 2 ? 4 * half * (u(random) - 0.5) : half + a * near * std::sin(turn);
    if (rho < 0.05 * a || std::fabs(rho - a) < 1e-6 * a)
      continue;  // cancellation in the formulas with K, E and Pi
    const double g = (a - rho) / (a + rho), n = 1 - g * g;
    Vec2 sheet, loop, b;
    for (const double side : {1.0, -1.0}) {
      const double zeta = z + side * half, x = zeta * zeta + (a + rho) * (a + rho), k2 = 4 * a * rho / x;
      const double k = std::sqrt(k2), kk = std::comp_ellint_1(k), e = std::comp_ellint_2(k);
      const double third = (1 - (1 - g) / n) * std::comp_ellint_3(k, n) + (1 - g) / n * kk;
      sheet.x += side * mu0_over_pi * a / std::sqrt(x) * (2 * e - (2 - k2) * kk) / k2;
      sheet.y += side * mu0_over_pi * a / (a + rho) * zeta / std::sqrt(x) * third;
    }
    axial::add_sheet(a, half, 1e-9, 1, {{&rho, 1}, {&z, 1}}, {{&b.x, 1}, {&b.y, 1}});
    INFO("rho ", rho, " z ", z);
    const double q = (z - half) * (z - half) + (a - rho) * (a - rho);
    const double precision = 1e-12 + 1e-15 * (4 * a * a / q + 1 / (g * g));
    CHECK(norm(b - sheet) < precision * norm(sheet));

    const double zl = z - half, x = zl * zl + (a + rho) * (a + rho), k = std::sqrt(4 * a * rho / x),
                 kk = std::comp_ellint_1(k), e = std::comp_ellint_2(k);
    loop = 0.5 * mu0_over_pi / std::sqrt(x) *
           Vec2{zl / rho * (-kk + (a * a + rho * rho + zl * zl) / q * e),
                kk + (a * a - rho * rho - zl * zl) / q * e};
    b = {};
    axial::add_loop(a, 1e-9, 1, {{&rho, 1}, {&zl, 1}}, {{&b.x, 1}, {&b.y, 1}});
    CHECK(norm(b - loop) < precision * norm(loop));
  }
}

TEST_CASE("on the axis: the closed forms; full accuracy close to the axis") {
  const double a = 0.005, half = 0.02, z = 0.013;
  for (const double rho : {0.0, 1e-15, 1e-9, 1e-6, 1e-5}) {
    double b_rho = 0, b_z = 0;
    axial::add_sheet(a, half, 1e-9, 5000, {{&rho, 1}, {&z, 1}}, {{&b_rho, 1}, {&b_z, 1}});
    const double u = z + half, v = z - half;
    const double axis = axial::kMu0 * 2500 * (u / norm(Vec2{u, a}) - v / norm(Vec2{v, a}));
    const double slope = axial::kMu0 * 2500 * a * a *
                         (std::pow(norm(Vec2{u, a}), -3) - std::pow(norm(Vec2{v, a}), -3));  // dB_z/dz
    INFO("rho ", rho);
    CHECK(b_z == doctest::Approx(axis).epsilon(1e-14 + 10 * (rho / a) * (rho / a)));
    if (rho > 0)
      CHECK(b_rho == doctest::Approx(-0.5 * rho * slope).epsilon(1e-14 + 10 * (rho / a) * (rho / a)));
    if (rho == 0) CHECK(b_rho == 0);
  }
}

TEST_CASE("on the sheet: the mean of both sides, a jump of mu0 K; finite at its rim and on a wire") {
  const double a = 0.005, half = 0.02;
  const auto b_z = [&](double rho, double z) {
    double x = 0, y = 0;
    axial::add_sheet(a, half, 5e-5, 1000, {{&rho, 1}, {&z, 1}}, {{&x, 1}, {&y, 1}});
    CHECK(std::isfinite(x));
    CHECK(std::isfinite(y));
    return y;
  };
  const double inside = b_z(a * (1 - 1e-9), 0.004), outside = b_z(a * (1 + 1e-9), 0.004);
  CHECK(inside - outside == doctest::Approx(axial::kMu0 * 1000).epsilon(1e-6));
  CHECK(b_z(a, 0.004) == doctest::Approx(0.5 * (inside + outside)).epsilon(1e-6));
  b_z(a, half);
  b_z(a, -half);
  double x = 0, y = 0;
  const double zero = 0;
  axial::add_loop(a, 5e-5, 1, {{&a, 1}, {&zero, 1}}, {{&x, 1}, {&y, 1}});
  CHECK(std::isfinite(x + y));
}

TEST_CASE("the field at a point does not depend on the other points of the call") {
  std::vector<double> rho, z;
  for (int i = 0; i < 1000; ++i) {
    rho.push_back(1e-5 * (i * 37 % 1000));
    z.push_back(1e-4 * (i * 91 % 700 - 350));
  }
  std::vector<double> all_rho(1000), all_z(1000);
  axial::add_sheet(0.005, 0.02, 1e-5, 1, {rho, z}, {all_rho, all_z});
  for (std::size_t i = 0; i < 1000; ++i) {
    double x = 0, y = 0;
    axial::add_sheet(0.005, 0.02, 1e-5, 1, {{&rho[i], 1}, {&z[i], 1}}, {{&x, 1}, {&y, 1}});
    // The number of passes of a tile is that of its most difficult point, sufficient for the others.
    CHECK(x == doctest::Approx(all_rho[i]).epsilon(1e-13));
    CHECK(y == doctest::Approx(all_z[i]).epsilon(1e-13));
  }
}

TEST_CASE("the table of a coil system is within its tolerance; coils in the sample are refused") {
  const std::string rig =
      "type = 'rig'\nearth = { field = ['10 uT', '-15 uT', 0] }\n[[coil]]\ntype = 'solenoid'\nposition = "
      "['35 mm', 0, 0]\naxis = [-1, 0, 0]\n[[coil]]\ntype = 'solenoid'\nposition = [0, '-35 mm', 0]\naxis = "
      "[0, 1, 0]\n";
  const auto f = field_of(rig);
  FieldTable table(*f, {-0.003, -0.002}, {0.003, 0.002});
  CHECK(table.error() <= FieldTable::kTolerance);
  const std::vector<double> current{0.4, -0.25};
  table.set(current);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> u(-0.003f, 0.003f), v(-0.002f, 0.002f);
  for (int i = 0; i < 500; ++i) {
    const float x = u(random), y = v(random);
    float bx = 0, by = 0;
    table.eval({{&x, 1}, {&y, 1}, 0}, {{&bx, 1}, {&by, 1}});
    const Vec3 exact = f->at({double(x), double(y), 0}, current);
    // Errors of both coils, each a fraction of its largest field, 0.5 mT/A at the near rim, and float
    // rounding.
    const double allowed = FieldTable::kTolerance * 0.65 * 0.5e-3 + 1e-7 * norm(exact);
    CHECK(norm(Vec2{double(bx) - exact.x, double(by) - exact.y}) < allowed);
  }
  CHECK_THROWS_AS(FieldTable(*f, {-0.02, -0.02}, {0.02, 0.02}), Error);
}
