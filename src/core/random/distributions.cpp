#include "core/random/distributions.h"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/error.h"

namespace faba {

double normal_quantile(double p) {
  if (!(p > 0 && p < 1))
    throw Error(Errc::internal, "normal_quantile", fmt::format("p is {}; it must be between 0 and 1", p));
  return boost::math::quantile(boost::math::normal(), p);
}

double student_t_cdf(double t, double freedom) {
  return boost::math::cdf(boost::math::students_t(freedom), t);
}

double student_t_quantile(double p, double freedom) {
  if (!(p > 0 && p < 1 && freedom > 0))
    throw Error(
        Errc::internal, "student_t_quantile",
        fmt::format("p is {} and must be between 0 and 1; freedom is {} and must be positive", p, freedom));
  return boost::math::quantile(boost::math::students_t(freedom), p);
}

}  // namespace faba
