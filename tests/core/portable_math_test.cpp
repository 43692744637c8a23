#include "core/portable_math.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace faba;

TEST_CASE("the errors of the float functions are within their documented bounds") {
  double worst_exp = 0, worst_log = 0, worst_sin = 0;
  for (int i = -400000; i <= 400000; ++i) {
    const auto x = float(i) * 2.1e-4f;
    worst_exp = std::max(worst_exp, std::fabs(double(portable::exp(x)) / std::exp(double(x)) - 1));
    const auto s = portable::sincos(x * 100);
    worst_sin = std::max({worst_sin, std::fabs(double(s.sin) - std::sin(double(x * 100))),
                          std::fabs(double(s.cos) - std::cos(double(x * 100)))});
    const float u = (float(i + 400001) - 0.5f) * 1.25e-6f;
    const double exact = std::log(double(u));
    worst_log =
        std::max(worst_log, std::fabs(double(portable::log(u)) - exact) / std::max(1.0, std::fabs(exact)));
  }
  CHECK(worst_exp < 2e-7);
  CHECK(worst_log < 1e-7);
  CHECK(worst_sin < 1.5e-7);
}

TEST_CASE("the errors of the double functions are a few ulp") {
  double worst = 0;
  for (int i = -50000; i <= 50000; ++i) {
    const double x = i * 0.00713;
    worst = std::max(worst, std::fabs(portable::exp(x) / std::exp(x) - 1));
    const auto s = portable::sincos(x * 50);
    worst = std::max({worst, std::fabs(s.sin - std::sin(x * 50)), std::fabs(s.cos - std::cos(x * 50))});
    const double a = portable::atan2(std::sin(x), 3 * std::cos(x));
    worst = std::max(worst, std::fabs(a - std::atan2(std::sin(x), 3 * std::cos(x))));
    const double l = std::log(std::exp(x));
    worst = std::max(worst, std::fabs(portable::log(std::exp(x)) - l) / std::max(1.0, std::fabs(l)));
  }
  CHECK(worst < 2e-15);
}

TEST_CASE("special arguments") {
  CHECK(portable::exp(0.0f) == 1.0f);
  CHECK(portable::exp(-1000.0f) > 0.0f);
  CHECK(portable::exp(-1000.0) == 0.0);
  CHECK(std::isinf(portable::exp(1000.0)));
  CHECK(std::isinf(portable::log(0.0)));
  CHECK(std::isnan(portable::log(-1.0)));
  CHECK(portable::atan2(0, 0) == 0);
  CHECK(portable::atan2(0, -1) == doctest::Approx(portable::kPi));
}

// Frozen values: the results must be bit-identical on every machine and at every optimisation level.
TEST_CASE("frozen bits") {
  CHECK(std::bit_cast<std::uint32_t>(portable::exp(1.2345f)) == 0x405bf23c);
  CHECK(std::bit_cast<std::uint32_t>(portable::log(0.7071f)) == 0xbeb1735b);
  CHECK(std::bit_cast<std::uint32_t>(portable::sincos(2.5f).sin) == 0x3f193579);
}

TEST_CASE("normal_cdf agrees with erfc") {
  for (double x = -9; x <= 9; x += 0.01)
    CHECK(std::fabs(portable::normal_cdf(x) - 0.5 * std::erfc(-x / std::sqrt(2.0))) < 1e-7);
}
