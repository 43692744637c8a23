// Zeros of the field: positions, currents and trapping gradients (theory C6).
#include "field/null.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "tests/field/field_of.h"
#include "tests/reference_rig.h"

using namespace faba;

namespace {

// The reference coil system (C4) with the coils at these angles, in degrees.
std::unique_ptr<Field> rig(const std::vector<double>& angles, const std::string& earth = "[0, 0, 0]") {
  return field_of("type = 'rig'\nearth = { field = " + earth + " }\n" + reference_coils("coil", angles));
}
const std::vector<double> kFour{0, 90, 180, 270};

Vec2 in_plane(const Field& f, Vec2 at, const std::vector<double>& current) {
  const Vec3 b = f.at({at.x, at.y, 0}, current);
  return {b.x, b.y};
}

}  // namespace

TEST_CASE("zeros of the reference coil system: currents and gradients of C6") {
  struct Row {
    Vec2 at;
    std::vector<double> current;
    double weaker, stronger;
  };
  const auto f = rig(kFour);
  // The reference searched directions in steps of about 0.01 rad; the exact solution is at least as good for
  // the weaker gradient, to the digits given, and its currents differ by up to 1 %.
  for (const Row& row : {Row{{0, 0}, {0.5, 0.5, 0.5, 0.5}, 0.0194, 0.0194},
                         Row{{1e-3, 0}, {0.43957, 0.48138, 0.5, 0.48138}, 0.01843, 0.01855},
                         Row{{2e-3, 1e-3}, {0.38565, 0.44019, 0.49375, 0.5}, 0.01565, 0.02005},
                         Row{{-3e-3, 4e-3}, {0.5, 0.32025, 0.37508, 0.49564}, 0.00465, 0.03046}}) {
    const FieldNull n = null_at(*f, row.at, 1, current_limits(*f));
    INFO(row.at.x, " ", row.at.y);
    CHECK(n.reachable);
    CHECK_FALSE(n.saddle);
    CHECK(norm(in_plane(*f, row.at, n.current)) < 1e-15);
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(n.current[k] == doctest::Approx(row.current[k]).epsilon(0.015));
      CHECK(n.current[k] <= 0.5 * (1 + 1e-12));
    }
    CHECK(-n.gradient[1] > row.weaker - 0.00001);
    CHECK(-n.gradient[0] == doctest::Approx(row.stronger).epsilon(0.01));
    CHECK(n.out_of_plane == doctest::Approx(-n.gradient[0] - n.gradient[1]).epsilon(1e-7));
    // South-seeking cells need all currents reversed.
    const FieldNull south = null_at(*f, row.at, -1, current_limits(*f));
    CHECK_FALSE(south.saddle);
    for (std::size_t k = 0; k < 4; ++k) CHECK(south.current[k] == doctest::Approx(-n.current[k]));
  }
}

TEST_CASE("two opposed coils make a saddle, and no zero off their axis") {
  const auto f = rig({0, 180});
  const FieldNull n = null_at(*f, {}, 1, current_limits(*f));
  CHECK(n.reachable);
  CHECK(n.saddle);
  CHECK(n.gradient[0] == doctest::Approx(-0.0388).epsilon(0.002));
  CHECK(n.gradient[1] == doctest::Approx(0.0194).epsilon(0.002));
  CHECK_FALSE(null_at(*f, {0, 1e-3}, 1, current_limits(*f)).reachable);
  // Unequal currents move it along the axis (C6).
  struct Row {
    double ratio, mm;
  };
  for (const Row& r : {Row{1.1, 0.364}, Row{1.25, 0.852}, Row{1.5, 1.546}, Row{2.0, 2.633}}) {
    const Vec2 at = find_null(*f, std::vector<double>{0.5 / r.ratio, 0.5}, {});
    CHECK(at.x * 1e3 == doctest::Approx(r.mm).epsilon(0.002));
    CHECK(std::fabs(at.y) < 1e-12);
  }
}

TEST_CASE("the Earth's field is cancelled at the zero, and shifts an uncompensated zero by B / g") {
  const auto f = rig(kFour, "['18 uT', 0, 0]");
  const FieldNull n = null_at(*f, {5e-4, -2e-4}, -1, current_limits(*f));
  CHECK(n.reachable);
  CHECK_FALSE(n.saddle);
  CHECK(norm(in_plane(*f, {5e-4, -2e-4}, n.current)) < 1e-15);
  const Vec2 at = find_null(*f, std::vector<double>{0.5, 0.5, 0.5, 0.5}, {});
  CHECK(at.x == doctest::Approx(18e-6 / 0.0194).epsilon(0.01));
}

TEST_CASE("any coil system: the field is zero, limits are kept, Newton's method finds the zero again") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<> u(-1, 1);
  for (const std::vector<double>& angles : {std::vector<double>{0, 90, 180, 270},
                                            {10, 130, 250},
                                            {0, 72, 144, 216, 288},
                                            {0, 45, 90, 135, 180, 225, 270, 315}}) {
    const auto f = rig(angles, "['5 uT', '-12 uT', 0]");
    for (int i = 0; i < 10; ++i) {
      const Vec2 at{2e-3 * u(random), 2e-3 * u(random)};
      const FieldNull n = null_at(*f, at, i % 2 ? 1 : -1, current_limits(*f));
      INFO(angles.size(), " coils, ", at.x, " ", at.y);
      REQUIRE(n.reachable);
      double largest = 0;
      for (const double c : n.current) largest = std::max(largest, std::fabs(c));
      CHECK(largest == doctest::Approx(0.5).epsilon(1e-9));
      CHECK(norm(in_plane(*f, at, n.current)) < 1e-15);
      if (n.saddle) continue;
      // From 0.1 mm beside it, where this zero is the nearest one.
      const Vec2 again = find_null(*f, n.current, at + Vec2{1e-4, 0});
      CHECK(norm(again - at) < 1e-10);
    }
  }
}

// Coils with unequal limits in a strong ambient field, where the least-squares currents may exceed a limit
// although others do not, and where there may be no trap.
TEST_CASE("unequal limits: no currents on a fine lattice are better, and reachable zeros are found") {
  std::mt19937_64 random(23);
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<>(lo, hi)(random); };
  int traps = 0, saddles = 0, none = 0;
  for (int i = 0; i < 60; ++i) {
    const auto f =
        rig({uniform(-25, 25), 90 + uniform(-25, 25), 180 + uniform(-25, 25), 270 + uniform(-25, 25)},
            fmt::format("[{}, {}, 0]", uniform(-1e-4, 1e-4), uniform(-1e-4, 1e-4)));
    std::vector<double> most;
    for (int k = 0; k < 4; ++k) most.push_back(std::exp(uniform(std::log(0.05), std::log(0.5))));
    const Vec2 at{uniform(-2e-3, 2e-3), uniform(-2e-3, 2e-3)};
    std::vector<Vec3> b(4);
    std::vector<Mat3> g(4);
    f->basis({at.x, at.y, 0}, b, g);
    const Vec3 earth = f->ambient();
    const double det = b[0].x * b[1].y - b[0].y * b[1].x;
    bool possible = false;
    double best = -1;  // T/m, of the weaker trap
    constexpr int kSteps = 150;
    for (int p = -kSteps; p <= kSteps; ++p)
      for (int q = -kSteps; q <= kSteps; ++q) {
        std::vector<double> c{0, 0, most[2] * p / kSteps, most[3] * q / kSteps};
        const double x = -earth.x - c[2] * b[2].x - c[3] * b[3].x,
                     y = -earth.y - c[2] * b[2].y - c[3] * b[3].y;
        c[0] = (x * b[1].y - y * b[1].x) / det;
        c[1] = (b[0].x * y - b[0].y * x) / det;
        if (std::fabs(c[0]) > most[0] || std::fabs(c[1]) > most[1]) continue;
        possible = true;
        double xx = 0, xy = 0, yy = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          xx += c[k] * g[k][0][0];
          yy += c[k] * g[k][1][1];
          xy += c[k] * 0.5 * (g[k][0][1] + g[k][1][0]);
        }
        best = std::max(best, -(0.5 * (xx + yy) + norm(Vec2{0.5 * (xx - yy), xy})));
      }
    const FieldNull n = null_at(*f, at, 1, most);
    INFO("case ", i, ", best of the lattice ", best);
    if (possible) {
      CHECK(n.reachable);
      for (std::size_t k = 0; k < 4; ++k) CHECK(std::fabs(n.current[k]) <= most[k] * (1 + 1e-9));
    }
    if (n.reachable) CHECK(norm(in_plane(*f, at, n.current)) < 1e-14);
    if (best > 0) {
      CHECK_FALSE(n.saddle);
      CHECK(-n.gradient[1] >= best - 1e-10);  // T/m; tolerance of the barrier: 1e-9 of 0.05 T/m
    }
    ++(!n.reachable ? none : n.saddle ? saddles : traps);
  }
  CHECK(traps > 5);
  CHECK(saddles > 5);
  CHECK(none > 5);
}
