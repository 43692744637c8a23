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

/// Probability of at most `k` successes in `n` trials with probability p of each. 0 for k < 0.
double binomial_cdf(int k, int n, double p);

/// Smallest and largest number of successes in `n` trials with probability p of each that are not in the
/// tails: each tail has a probability of at most (1 - level) / 2.
struct BinomialRange {
  int low = 0, high = 0;
};
BinomialRange binomial_range(int n, double p, double level);

/// Confidence interval of a probability after `k` successes in `n` > 0 trials (Clopper and Pearson 1934).
struct FractionInterval {
  double low = 0, high = 1;
};
FractionInterval binomial_interval(int k, int n, double level);

/// Probability that a chi-square variable with `freedom` > 0 degrees of freedom is at least x >= 0.
double chi_square_tail(double x, double freedom);

}  // namespace faba
