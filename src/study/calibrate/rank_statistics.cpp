#include "study/calibrate/rank_statistics.h"

#include <algorithm>
#include <cmath>

#include "core/random/distributions.h"

namespace faba {
namespace {

constexpr double kBandLevel = 0.99;
constexpr int kPerBin = 15, kFewestBins = 5, kMostBins = 20;
constexpr int kCurvePoints = 40;

int count_outside(const std::vector<int>& counts, int low, int high) {
  return int(std::count_if(counts.begin(), counts.end(), [&](int n) { return n < low || n > high; }));
}

// Probability of a larger distance between a uniform distribution and that of n samples (Kolmogorov 1933),
// with the correction of Stephens (1970) for finite n.
double kolmogorov_tail(double distance, double n) {
  const double x = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  if (x < 0.2) return 1;
  double sum = 0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2 : -2) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

std::array<double, 2> Coverage::ci95() const {
  const FractionInterval i = binomial_interval(inside, experiments, 0.95);
  return {i.low, i.high};
}

Coverage coverage_of(const std::vector<double>& ranks, double level) {
  Coverage c{.level = level, .experiments = int(ranks.size())};
  for (const double r : ranks) c.inside += std::fabs(r - 0.5) <= 0.5 * level;
  const BinomialRange range = binomial_range(c.experiments, level, kBandLevel);
  c.low = range.low;
  c.high = range.high;
  return c;
}

int RankHistogram::outside() const { return count_outside(counts, low, high); }
int RankHistogram::outside_each() const { return count_outside(counts, low_each, high_each); }

RankHistogram rank_histogram(const std::vector<double>& ranks) {
  const int n = int(ranks.size()), bins = std::clamp(n / kPerBin, kFewestBins, kMostBins);
  RankHistogram h;
  h.counts.assign(std::size_t(bins), 0);
  for (const double r : ranks) ++h.counts[std::size_t(std::clamp(int(r * bins), 0, bins - 1))];
  h.expected = double(n) / bins;
  const BinomialRange all = binomial_range(n, 1.0 / bins, 1 - (1 - kBandLevel) / bins),
                      each = binomial_range(n, 1.0 / bins, kBandLevel);
  h.low = all.low;
  h.high = all.high;
  h.low_each = each.low;
  h.high_each = each.high;
  double chi_square = 0;
  for (const int count : h.counts)
    chi_square += std::pow(count - h.expected, 2) / std::max(1e-12, h.expected);
  h.p = chi_square_tail(chi_square, bins - 1);
  return h;
}

RankCurve rank_curve(std::vector<double> ranks) {
  std::sort(ranks.begin(), ranks.end());
  const int n = int(ranks.size());
  RankCurve c;
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double at = double(i) / kCurvePoints;
    const auto below = std::upper_bound(ranks.begin(), ranks.end(), at) - ranks.begin();
    const BinomialRange range = binomial_range(n, at, kBandLevel);
    c.at.push_back(at);
    c.fraction.push_back(double(below) / std::max(1, n));
    c.low.push_back(double(range.low) / std::max(1, n));
    c.high.push_back(double(range.high) / std::max(1, n));
  }
  for (int i = 0; i < n; ++i) {
    const double r = ranks[std::size_t(i)];
    c.largest = std::max({c.largest, double(i + 1) / n - r, r - double(i) / n});
  }
  c.p = kolmogorov_tail(c.largest, n);
  return c;
}

}  // namespace faba
