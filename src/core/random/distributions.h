#pragma once

namespace faba {

/// Quantile of the standard normal distribution at probability p, 0 < p < 1. Throws Error(Errc::internal) for
/// other p.
double normal_quantile(double p);

/// Cumulative distribution function of Student's t with `freedom` > 0 degrees of freedom: the probability of
/// a value below t.
double student_t_cdf(double t, double freedom);

/// Quantile of Student's t at probability p, the inverse of student_t_cdf(). student_t_quantile(0.975,
/// freedom) gives a two-sided 95 % interval. Throws Error(Errc::internal) unless 0 < p < 1 and freedom > 0.
double student_t_quantile(double p, double freedom);

}  // namespace faba
