// The fields that coils can produce at a point (theory C8), compared with a search over currents.
#include "field/field_range.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "field/null.h"
#include "tests/field/field_of.h"
#include "tests/reference_rig.h"

using namespace faba;

namespace {

constexpr double kPi = 3.14159265358979323846;

std::unique_ptr<Field> rig(const std::vector<double>& angles, const std::string& earth = "[0, 0, 0]") {
  return field_of("type = 'rig'\nearth = { field = " + earth + " }\n" + reference_coils("coil", angles));
}

FieldRange range_of(const Field& f, Vec3 at = {}) { return {f, at, current_limits(f)}; }

// Largest r with r u = B_E + sum of I_k b_k: at the optimum all currents but one are at their limits, because
// it is on a side of the polygon.
double searched(const Field& f, Vec3 at, double angle) {
  const std::size_t n = f.coils();
  std::vector<Vec3> b(n);
  f.basis(at, b, {});
  const std::vector<double> most = current_limits(f);
  const Vec2 u{std::cos(angle), std::sin(angle)};
  double best = 0;
  for (std::size_t free = 0; free < n; ++free)
    for (unsigned signs = 0; signs < (1u << n); ++signs) {
      Vec2 fixed{f.ambient().x, f.ambient().y};
      for (std::size_t k = 0; k < n; ++k)
        if (k != free) fixed = fixed + (signs >> k & 1 ? most[k] : -most[k]) * Vec2{b[k].x, b[k].y};
      // fixed + I b = r u, by Cramer's rule.
      const Vec2 c{b[free].x, b[free].y};
      const double determinant = c.x * u.y - c.y * u.x;
      if (std::fabs(determinant) < 1e-12 * norm(c)) continue;
      const double current = (fixed.y * u.x - fixed.x * u.y) / determinant;
      if (std::fabs(current) <= most[free] * (1 + 1e-9)) best = std::max(best, dot(fixed + current * c, u));
    }
  return best;
}

}  // namespace

TEST_CASE("the largest field in a direction: a search over currents gives the same") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, 2 * kPi), place(-4e-3, 4e-3);
  for (const auto& angles :
       {std::vector<double>{0, 90, 180, 270}, std::vector<double>{0, 120, 240}, std::vector<double>{10, 95}})
    for (const std::string earth : {"[0, 0, 0]", "['18 uT', '-9 uT', 0]"}) {
      const auto f = rig(angles, earth);
      for (int i = 0; i < 20; ++i) {
        const Vec3 at{place(random), place(random), 0};
        const double direction = angle(random);
        CHECK(range_of(*f, at).along(direction) ==
              doctest::Approx(searched(*f, at, direction)).epsilon(1e-7));
      }
    }
}

TEST_CASE("the weakest direction is the minimum over all directions") {
  const auto f = rig({0, 90, 180, 270}, "['5 uT', '2 uT', 0]");
  const FieldRange range = range_of(*f, {1e-3, 5e-4, 0});
  const auto weakest = range.weakest();
  CHECK(range.along(weakest.angle) == doctest::Approx(weakest.tesla).epsilon(1e-9));
  for (int i = 0; i < 3600; ++i) CHECK(range.along(i * kPi / 1800) >= weakest.tesla * (1 - 1e-9));
}

TEST_CASE("four coils: at the centre the weakest direction is along a pair at its largest currents") {
  const auto f = rig({0, 90, 180, 270});
  std::vector<Vec3> b(4);
  f->basis({}, b, {});
  const auto weakest = range_of(*f).weakest();
  CHECK(weakest.tesla == doctest::Approx(2 * 0.5 * norm(b[0])).epsilon(1e-9));
  // Diagonally both pairs contribute.
  CHECK(range_of(*f).along(kPi / 4) == doctest::Approx(std::sqrt(2.0) * weakest.tesla).epsilon(1e-9));
}

TEST_CASE("coils with parallel fields produce one direction only") {
  const auto f = rig({0, 180});
  const FieldRange range = range_of(*f);
  CHECK(range.weakest().tesla == 0);
  CHECK(std::fabs(std::cos(range.weakest().angle)) < 1e-6);
  CHECK(range.along(0) > 1e-4);
  CHECK(range.along(kPi / 2) == 0);
  CHECK(range.along(0.1) == 0);
  // The Earth's field across the axis leaves the fields on a line beside the origin.
  const auto shifted = rig({0, 180}, "[0, '18 uT', 0]");
  CHECK(range_of(*shifted).along(0) == 0);
  CHECK(range_of(*shifted).weakest().tesla == 0);
  CHECK(range_of(*shifted).along(kPi / 4) == doctest::Approx(18e-6 * std::sqrt(2.0)).epsilon(1e-6));
}

TEST_CASE("the field in a winding and without coils in the plane") {
  const auto vertical = field_of(
      "type = 'rig'\ncoil = [{ type = 'loop', radius = '1 cm', turns = 100, max_current = '1 A' }]\n");
  CHECK(range_of(*vertical).weakest().tesla == 0);
  CHECK(range_of(*vertical).along(1) == 0);
}
