#include "core/random/distributions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "core/error.h"

using namespace faba;

namespace {

struct Entry {
  double argument, freedom, value;
};

}  // namespace

TEST_CASE("Student's t: degrees of freedom with a closed form") {
  // One degree of freedom is the Cauchy distribution; two and four have algebraic distribution functions.
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

// Computed with 40 digits by mpmath 1.3 (https://mpmath.org) from the regularised incomplete beta function,
// F(t) = 1/2 I_x(n / 2, 1/2) with x = n / (n + t^2) for t < 0 (https://dlmf.nist.gov/8.17).
TEST_CASE("Student's t: reference values of high precision") {
  for (const auto& [t, n, p] :
       {Entry{-2.5, 5, 0.027245049671188121}, Entry{1, 7, 0.82469166858989624},
        Entry{-12, 6, 1.0153703097686596e-5}, Entry{0.3, 33.5, 0.61698456330459673},
        Entry{-4.5, 400, 4.4606426890247631e-6}, Entry{-40, 10, 1.1404288715428773e-12}})
    CHECK(std::fabs(student_t_cdf(t, n) / p - 1) < 1e-12);
  for (const auto& [p, n, t] :
       {Entry{0.975, 3, 3.1824463052837096}, Entry{0.975, 8, 2.3060041352041667},
        Entry{0.975, 19, 2.0930240544083098}, Entry{0.95, 30, 1.6972608865939578},
        Entry{0.975, 100, 1.9839715185235523}, Entry{0.975, 1000, 1.9623390808264085}})
    CHECK(std::fabs(student_t_quantile(p, n) / t - 1) < 1e-12);
}

// By mpmath as above: sqrt(2) erfinv(2 p - 1).
TEST_CASE("quantiles of the normal distribution") {
  for (const auto& [p, z] : {std::pair{0.0001, -3.7190164854556806},
                             {0.025, -1.9599639845400542},
                             {0.2, -0.84162123357291421},
                             {0.75, 0.67448975019608174},
                             {0.9, 1.2815515655446005},
                             {0.999, 3.0902323061678135}})
    CHECK(std::fabs(normal_quantile(p) / z - 1) < 1e-12);
  CHECK(normal_quantile(0.5) == 0);
  CHECK_THROWS_AS(normal_quantile(0), Error);
  CHECK_THROWS_AS(normal_quantile(1), Error);
}

TEST_CASE("quantiles agree with published tables and invert the distribution function") {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2.
  CHECK(student_t_quantile(0.975, 1) == doctest::Approx(12.706).epsilon(5e-5));
  CHECK(student_t_quantile(0.975, 8) == doctest::Approx(2.306).epsilon(5e-4));
  CHECK(student_t_quantile(0.975, 100) == doctest::Approx(1.984).epsilon(5e-4));
  CHECK(student_t_quantile(0.95, 30) == doctest::Approx(1.697).epsilon(5e-4));
  CHECK(student_t_quantile(0.975, 1e7) == doctest::Approx(1.959964).epsilon(1e-6));  // the normal quantile
  for (const double freedom : {1.0, 3.0, 8.0, 33.5, 400.0})
    for (const double p : {1e-6, 0.02, 0.4, 0.7, 0.995})
      CHECK(student_t_cdf(student_t_quantile(p, freedom), freedom) == doctest::Approx(p).epsilon(1e-11));
  CHECK_THROWS_AS(student_t_quantile(0, 3), Error);
  CHECK_THROWS_AS(student_t_quantile(1, 3), Error);
  CHECK_THROWS_AS(student_t_quantile(0.5, 0), Error);
}
