#include "study/stats/statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/random/distributions.h"

using namespace faba;

TEST_CASE("line fit with residuals calculated by hand") {
  // y = 1 + 2 x plus +1, -1, -1, +1, which are orthogonal to any line.
  const std::vector<double> x{-3, -1, 1, 3}, y{-4, -2, 2, 8};
  const LineFit f = fit_line(x, y);
  CHECK(f.slope == doctest::Approx(2));
  CHECK(f.intercept == doctest::Approx(1));
  CHECK(f.freedom == 2);
  CHECK(f.sd == doctest::Approx(std::sqrt(4.0 / 2)));
  CHECK(f.se_slope == doctest::Approx(std::sqrt(2.0 / 20)));
  CHECK(f.se_intercept == doctest::Approx(std::sqrt(2.0 / 4)));
  CHECK(f.slope_ci95()[1] == doctest::Approx(2 + 4.302652729749 * std::sqrt(0.1)));
  CHECK(f.intercept_ci95()[0] == doctest::Approx(1 - 4.302652729749 * std::sqrt(0.5)));
  CHECK_THROWS_AS(fit_line(std::vector<double>{1, 2}, std::vector<double>{1, 2}), Error);
  CHECK_THROWS_AS(fit_line(std::vector<double>{1, 1, 1}, std::vector<double>{1, 2, 3}), Error);
}

TEST_CASE("Spearman's correlation and its p-value") {
  const std::vector<double> x{1, 2, 3, 4, 5}, up{2, 3, 50, 51, 1000}, down{9, 8, 7, 6, 5},
      ties{1, 1, 2, 2, 3};
  CHECK(spearman(x, up) == doctest::Approx(1));
  CHECK(spearman(x, down) == doctest::Approx(-1));
  CHECK(spearman(x, std::vector<double>{4, 4, 4, 4, 4}) == 0);
  // Ranks 1.5 1.5 3.5 3.5 5: covariance 9, variances 10 and 9.
  CHECK(spearman(x, ties) == doctest::Approx(9 / std::sqrt(90.0)));
  CHECK(spearman_p(x, up) == doctest::Approx(2.0 / 120));  // two of 5! orders
  std::vector<double> many(12), other(12);
  for (std::size_t i = 0; i < 12; ++i) {
    many[i] = double(i);
    other[i] = double((i * 7) % 12);
  }
  const double rho = spearman(many, other), t = std::fabs(rho) * std::sqrt(10 / (1 - rho * rho));
  CHECK(spearman_p(many, other) == doctest::Approx(2 * (1 - student_t_cdf(t, 10))).epsilon(1e-9));
}

TEST_CASE("standard deviation") {
  CHECK(sample_sd(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9}) == doctest::Approx(std::sqrt(32.0 / 7)));
  CHECK(sample_sd(std::vector<double>{3}) == 0);
}
