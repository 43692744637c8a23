// Fieller interval of the zero of a line, against its definition: the values of x at which the fitted line is
// not significantly different from zero (t-test).
#include "study/identify/legacy_selection.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/random/distributions.h"

using namespace faba;

TEST_CASE("Fieller interval: at its limits the line is t standard errors from zero") {
  const std::vector<double> x{1, 5, 10, 15, 20}, y{0.21, 0.1, 0.02, -0.06, -0.2};
  const LineFit f = fit_line(x, y);
  const double mean_x = 10.2;
  const auto ci = zero_crossing_ci95(f, mean_x);
  REQUIRE(ci);
  const double zero = -f.intercept / f.slope, t = student_t_quantile(0.975, f.freedom);
  CHECK((*ci)[0] < zero);
  CHECK(zero < (*ci)[1]);
  double sxx = 0;
  for (const double v : x) sxx += (v - mean_x) * (v - mean_x);
  for (const double at : *ci) {
    const double se = f.sd * std::sqrt(1.0 / 5 + (at - mean_x) * (at - mean_x) / sxx);
    CHECK(std::fabs(f.intercept + f.slope * at) == doctest::Approx(t * se).epsilon(1e-9));
  }
}

TEST_CASE("Fieller interval: unbounded for a slope that is not significant") {
  const std::vector<double> x{1, 5, 10, 15, 20}, y{0.2, 0.1, 0.3, 0.05, 0.24};
  CHECK_FALSE(zero_crossing_ci95(fit_line(x, y), 10.2));
}
