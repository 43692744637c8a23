#pragma once
#include <algorithm>
#include <limits>
#include <vector>

namespace faba {

/// Mean vectors over spans of time, however long it gets: when time runs out of its 512 spans, two become
/// one.
class TimeBins {
 public:
  explicit TimeBins(double span_s);
  void add(double t_s, double x, double y);

  struct Span {
    double time_s = 0;            ///< its middle
    double x = 0, y = 0;          ///< means; NaN where there is none
    double order = 0, count = 0;  ///< length of the mean over the mean length, NaN for fewer than five
  };
  /// Up to the last one that holds something.
  std::vector<Span> spans() const;

 private:
  void fold();
  double span_s_;
  std::vector<double> x_, y_, length_, n_;
};

/// Where `share` of all counts lie below: value_at(number of bin, with its fraction). NaN when all are 0.
template <class ValueAt>
double binned_quantile(const std::vector<double>& counts, double share, const ValueAt& value_at) {
  double total = 0, sum = 0;
  for (const double c : counts) total += c;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (sum + counts[i] >= share * total && counts[i] > 0)
      return value_at(double(i) + std::clamp((share * total - sum) / counts[i], 0.0, 1.0));
    sum += counts[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace faba
