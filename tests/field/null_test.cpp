// Zeros of the field: where they are, what they cost and whom they trap (theory C6).
#include "field/null.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tests/field/field_of.h"
#include "tests/reference_rig.h"

using namespace faba;

namespace {

// The reference rig (C4) with the coils at these angles, in degrees.
std::unique_ptr<Field> rig(const std::vector<double>& angles, const std::string& earth = "[0, 0, 0]") {
  return field_of("type = 'rig'\nearth = { field = " + earth + " }\n" + reference_coils("coil", angles));
}
const std::vector<double> kFour{0, 90, 180, 270};

Vec2 in_plane(const Field& f, Vec2 at, const std::vector<double>& current) {
  const Vec3 b = f.at({at.x, at.y, 0}, current);
  return {b.x, b.y};
}

}  // namespace

TEST_CASE("the reference rig's zeros: currents and gradients of C6") {
  struct Row {
    Vec2 at;
    std::vector<double> current;
    double weaker, stronger;
  };
  const auto f = rig(kFour);
  // The reference chose among directions some hundredths of a radian apart; the exact choice is at least as
  // good for the weaker gradient, to the digits given, and a per cent away in the currents.
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

TEST_CASE("two opposed coils make a saddle, and off their axis no zero at all") {
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

TEST_CASE("the Earth's field is cancelled at the zero, and shifts an uncorrected one by B / g") {
  const auto f = rig(kFour, "['18 uT', 0, 0]");
  const FieldNull n = null_at(*f, {5e-4, -2e-4}, -1, current_limits(*f));
  CHECK(n.reachable);
  CHECK_FALSE(n.saddle);
  CHECK(norm(in_plane(*f, {5e-4, -2e-4}, n.current)) < 1e-15);
  const Vec2 at = find_null(*f, std::vector<double>{0.5, 0.5, 0.5, 0.5}, {});
  CHECK(at.x == doctest::Approx(18e-6 / 0.0194).epsilon(0.01));
}

TEST_CASE("any rig: the zero is zero, limits are kept, Newton finds it again") {
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
      // From a tenth of a millimetre beside it, where this zero is the nearest one.
      const Vec2 again = find_null(*f, n.current, at + Vec2{1e-4, 0});
      CHECK(norm(again - at) < 1e-10);
    }
  }
}
