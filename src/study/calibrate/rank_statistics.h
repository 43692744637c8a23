#pragma once
#include <array>
#include <string>
#include <vector>

namespace faba {

/// Fraction of the experiments whose interval of a nominal level contains the true value.
struct Coverage {
  double level = 0;
  int inside = 0, experiments = 0;
  int low = 0, high = 0;  ///< 99 % range of `inside` for calibrated intervals
  double fraction() const { return double(inside) / double(experiments); }
  bool within() const { return inside >= low && inside <= high; }
  /// Whether there are enough experiments to detect intervals that are too narrow or too wide.
  bool tells() const { return low > 0 && high < experiments; }
  std::array<double, 2> ci95() const;  ///< of the fraction (Clopper and Pearson)
};

/// Levels of the intervals that are tested.
inline constexpr double kCoverageLevels[] = {0.5, 0.8, 0.9, 0.95};

/// Coverage of central intervals from the ranks of the true values, 0 to 1.
Coverage coverage_of(const std::vector<double>& ranks, double level);

/// Histogram of ranks, which is flat for a calibrated posterior (Talts et al. 2018).
struct RankHistogram {
  std::vector<int> counts;
  double expected = 0;    ///< count in each bin
  int low = 0, high = 0;  ///< all counts are within this range with a probability of 99 % (Bonferroni)
  int low_each = 0, high_each = 0;  ///< each count is within this range with a probability of 99 %
  double p = 1;                     ///< chi-square test
  int outside() const;              ///< number of counts outside of low to high
  int outside_each() const;
};

/// Bins: one for each 15 experiments, 5 to 20.
RankHistogram rank_histogram(const std::vector<double>& ranks);

/// Fraction of the experiments with a rank of at most `at`, with a pointwise 99 % band (binomial).
struct RankCurve {
  std::vector<double> at, fraction, low, high;
  double largest = 0;  ///< largest difference between fraction and `at`
  double p = 1;        ///< of this difference (Kolmogorov and Smirnov, asymptotic)
};
RankCurve rank_curve(std::vector<double> ranks);

}  // namespace faba
