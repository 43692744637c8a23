#include "study/identify/u_turn.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace faba;

// Table in theory B2: moment, field, U-turn time with the logarithm of 2 mB/kT, and turning rate mB/f_r. With
// the 2-D cut-off the argument of the logarithm is twice as large.
TEST_CASE("U-turn time: logarithmic law with the drag of the model") {
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
