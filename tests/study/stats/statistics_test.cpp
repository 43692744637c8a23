#include "study/stats/statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/error.h"

using namespace faba;

TEST_CASE("Student's t where it has a closed form") {
  // One degree of freedom is Cauchy's distribution; two and four have algebraic ones.
  for (const double t : {-30.0, -2.5, -0.3, 0.0, 0.7, 4.0, 100.0}) {
    CHECK(student_t_cdf(t, 1) == doctest::Approx(0.5 + std::atan(t) / std::acos(-1.0)).epsilon(1e-13));
    CHECK(student_t_cdf(t, 2) == doctest::Approx(0.5 + t / (2 * std::sqrt(2 + t * t))).epsilon(1e-12));
    const double u = t / std::sqrt(4 + t * t);
    CHECK(student_t_cdf(t, 4) == doctest::Approx(0.5 + 0.75 * u * (1 - u * u / 3)).epsilon(1e-12));
  }
  for (const double p : {0.001, 0.025, 0.3, 0.5, 0.975, 0.9999}) {
    const double q = student_t_quantile(p, 2);
    CHECK(q == doctest::Approx((2 * p - 1) * std::sqrt(2 / (4 * p * (1 - p)))).epsilon(1e-11));
  }
}

TEST_CASE("quantiles as tables have them, and back") {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2.
  CHECK(student_t_quantile(0.975, 1) == doctest::Approx(12.706).epsilon(5e-5));
  CHECK(student_t_quantile(0.975, 8) == doctest::Approx(2.306).epsilon(5e-4));
  CHECK(student_t_quantile(0.975, 100) == doctest::Approx(1.984).epsilon(5e-4));
  CHECK(student_t_quantile(0.95, 30) == doctest::Approx(1.697).epsilon(5e-4));
  CHECK(student_t_quantile(0.975, 1e7) == doctest::Approx(1.959964).epsilon(1e-6));  // the normal one
  for (const double freedom : {1.0, 3.0, 8.0, 33.5, 400.0})
    for (const double p : {1e-6, 0.02, 0.4, 0.7, 0.995})
      CHECK(student_t_cdf(student_t_quantile(p, freedom), freedom) == doctest::Approx(p).epsilon(1e-11));
  CHECK_THROWS_AS(student_t_quantile(0, 3), Error);
  CHECK_THROWS_AS(student_t_quantile(0.5, 0), Error);
}

TEST_CASE("a line with residuals that can be done by hand") {
  // y = 1 + 2 x with +1, -1, -1, +1 on top, which no line can take up.
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

TEST_CASE("Spearman's correlation and how likely it is") {
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
