#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// How alike the bins of a histogram are, 0 (nothing in common) to 1 (the same).
class BinSimilarity {
 public:
  /// 1 - |i - j| / threshold where that is positive, else 0 (theory A18); threshold in bins, > 0; 1 or less
  /// makes all bins strangers. Throws Error(usage, "threshold").
  static BinSimilarity truncated_linear(double threshold);
  /// A given matrix of n by n numbers, row by row. Throws Error(input, name) unless all are finite and >= 0
  /// and no A_ij is above A_ii, without which the distance means nothing.
  static BinSimilarity given(std::vector<double> matrix, std::size_t n, const std::string& name);

  /// Number of bins that it is made for; 0: any.
  std::size_t bins() const { return bins_; }
  /// How many bins to either side of n may count.
  std::size_t reach(std::size_t n) const { return taps_.size() < n ? taps_.size() : n; }
  /// out = A in, of n bins. For a banded one zeros stand around `in` as far as it reaches, and both can be
  /// written 32 bins beyond their end.
  void apply(const double* in, double* out, std::size_t n) const;

 private:
  std::size_t bins_ = 0;
  std::vector<double> taps_;    ///< A_i,i+k for k = 0, 1 ..., of a banded one
  std::vector<double> matrix_;  ///< bins_ by bins_
};

/// The Quadratic-Chi distance of Pele and Werman (2010; theory A18):
/// sqrt(sum_ij D_i D_j A_ij), D_i = (P_i - Q_i) / (sum_c (P_c + Q_c) A_ci)^m, 0/0 = 0. No distance between
/// probabilities: it grows with what is in the histograms as that to the power 1 - m, and no further when a
/// peak has moved by more than the threshold.
class HistogramDistance {
 public:
  /// 0 <= m < 1 (m = 1 is not continuous). Throws Error(usage, "m").
  HistogramDistance(BinSimilarity similarity, double m);
  /// P and Q of the same length, finite and >= 0; else Error(input, "histogram") naming the bin.
  double operator()(std::span<const double> p, std::span<const double> q);

 private:
  BinSimilarity similarity_;
  double m_;
  std::size_t bins_ = 0;  ///< of the last pair, for which the memory below is made
  std::vector<double> sum_, weight_, d_;
};

}  // namespace faba
