#include "core/random/distributions.h"

#include <fmt/format.h>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/error.h"

namespace faba {
namespace {

namespace math = boost::math;
// Computes in double: long double, the default, has 80 bits on x86-64 and 128 bits on arm64.
using InDouble = math::policies::policy<math::policies::promote_double<false>>;
using Normal = math::normal_distribution<double, InDouble>;
using StudentsT = math::students_t_distribution<double, InDouble>;
using Binomial = math::binomial_distribution<double, InDouble>;
using Beta = math::beta_distribution<double, InDouble>;
using ChiSquared = math::chi_squared_distribution<double, InDouble>;

}  // namespace

double normal_quantile(double p) {
  if (!(p > 0 && p < 1))
    throw Error(Errc::internal, "normal_quantile", fmt::format("p is {}; it must be between 0 and 1", p));
  return math::quantile(Normal(), p);
}

double student_t_cdf(double t, double freedom) { return math::cdf(StudentsT(freedom), t); }

double student_t_quantile(double p, double freedom) {
  if (!(p > 0 && p < 1 && freedom > 0))
    throw Error(
        Errc::internal, "student_t_quantile",
        fmt::format("p is {} and must be between 0 and 1; freedom is {} and must be positive", p, freedom));
  return math::quantile(StudentsT(freedom), p);
}

double binomial_cdf(int k, int n, double p) {
  if (k < 0) return 0;
  if (k >= n) return 1;
  return math::cdf(Binomial(n, p), k);
}

BinomialRange binomial_range(int n, double p, double level) {
  const double tail = (1 - level) / 2;
  BinomialRange r{0, n};
  while (r.low < n && binomial_cdf(r.low, n, p) <= tail) ++r.low;
  while (r.high > 0 && 1 - binomial_cdf(r.high - 1, n, p) <= tail) --r.high;
  return r;
}

FractionInterval binomial_interval(int k, int n, double level) {
  if (n < 1 || k < 0 || k > n || !(level > 0 && level < 1))
    throw Error(Errc::internal, "binomial_interval", fmt::format("{} of {}, level {}", k, n, level));
  const double tail = (1 - level) / 2;
  FractionInterval i;
  if (k > 0) i.low = math::quantile(Beta(k, n - k + 1), tail);
  if (k < n) i.high = math::quantile(Beta(k + 1, n - k), 1 - tail);
  return i;
}

double chi_square_tail(double x, double freedom) {
  return math::cdf(math::complement(ChiSquared(freedom), x));
}

}  // namespace faba
