#include "study/identify/u_turn.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace faba;

// Theory B2's table: moment, field, time of a U-turn by the logarithm of 2 mB/kT, and turning rate mB/f_r.
// With the 2-D cut the logarithm is of twice that.
TEST_CASE("a U-turn takes as long as its log law says, with the model's own drag") {
  const Json model{{"type", "dipole"}};
  struct Row {
    double moment, field_t, turn_s, rate;
  };
  for (const Row r : {Row{1e-15, 1e-4, 0.298, 13.0}, Row{2e-16, 1e-3, 0.176, 26.1}})
    CHECK(u_turn_s(model, r.moment, r.field_t) ==
          doctest::Approx(r.turn_s + std::log(2) / r.rate).epsilon(0.005));
  CHECK(u_turn_s({{"type", "dipole"}, {"radius", "1.4 um"}}, 1e-15, 1e-4) ==
        doctest::Approx(8 * u_turn_s(model, 1e-15, 1e-4)).epsilon(1e-9));
  CHECK(std::isinf(u_turn_s(model, 1e-20, 1e-6)));
}
