#pragma once

namespace faba {

/// The value below which a standard normal variable lies with probability p, 0 < p < 1. Throws
/// Error(Errc::internal) for other p.
double normal_quantile(double p);

/// Student's t distribution with `freedom` > 0 degrees of freedom: the probability of a value below t.
double student_t_cdf(double t, double freedom);

/// Its inverse: the t below which a value lies with probability p. student_t_quantile(0.975, freedom) makes a
/// two-sided 95 % interval. Throws Error(Errc::internal) unless 0 < p < 1 and freedom > 0.
double student_t_quantile(double p, double freedom);

}  // namespace faba
