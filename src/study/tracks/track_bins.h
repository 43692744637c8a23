#pragma once
#include <algorithm>
#include <limits>
#include <vector>

namespace faba {

/// Mean vectors in time bins for any duration: when the 512 bins are used up, pairs of bins are merged.
class TimeBins {
 public:
  explicit TimeBins(double span_s);
  void add(double t_s, double x, double y);

  struct Span {
    double time_s = 0;            ///< centre of the bin
    double x = 0, y = 0;          ///< means; NaN when empty
    double order = 0, count = 0;  ///< length of the mean over mean length; NaN for fewer than five
  };
  /// The bins up to the last one that is not empty.
  std::vector<Span> spans() const;

 private:
  void fold();
  double span_s_;
  std::vector<double> x_, y_, length_, n_;
};

/// Quantile of binned counts: value_at(fractional bin index). NaN when all counts are 0.
template <class ValueAt>
double binned_quantile(const std::vector<double>& counts, double fraction, const ValueAt& value_at) {
  double total = 0, sum = 0;
  for (const double c : counts) total += c;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (sum + counts[i] >= fraction * total && counts[i] > 0)
      return value_at(double(i) + std::clamp((fraction * total - sum) / counts[i], 0.0, 1.0));
    sum += counts[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace faba
