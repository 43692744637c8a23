#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// Similarity matrix of histogram bins: 0 (unrelated) to 1 (identical).
class BinSimilarity {
 public:
  /// max(0, 1 - |i - j| / threshold) (theory A18); threshold in bins, > 0; with 1 or less all bins are
  /// unrelated. Throws Error(usage, "threshold").
  static BinSimilarity truncated_linear(double threshold);
  /// An n x n matrix, row by row. Throws Error(input, name) unless all elements are finite and >= 0 and A_ij
  /// <= A_ii, which the distance requires.
  static BinSimilarity given(std::vector<double> matrix, std::size_t n, const std::string& name);

  /// Number of bins of the matrix; 0: any.
  std::size_t bins() const { return bins_; }
  /// Band width: number of bins to either side with non-zero similarity, at most n.
  std::size_t reach(std::size_t n) const { return taps_.size() < n ? taps_.size() : n; }
  /// out = A in, for n bins. For a banded matrix, `in` must have reach(n) zeros on both sides, and both
  /// arrays must be writable 32 elements beyond their end.
  void apply(const double* in, double* out, std::size_t n) const;

 private:
  std::size_t bins_ = 0;
  std::vector<double> taps_;    ///< A_i,i+k for k = 0, 1 ... of a banded matrix
  std::vector<double> matrix_;  ///< bins_ by bins_
};

/// The Quadratic-Chi distance of Pele and Werman (2010; theory A18): sqrt(sum_ij D_i D_j A_ij), D_i = (P_i -
/// Q_i) / (sum_c (P_c + Q_c) A_ci)^m, 0/0 = 0. Not normalised: it scales with the histogram content to the
/// power 1 - m, and saturates when a peak moves by more than the threshold.
class HistogramDistance {
 public:
  /// 0 <= m < 1 (not continuous at m = 1). Throws Error(usage, "m").
  HistogramDistance(BinSimilarity similarity, double m);
  /// P and Q have the same length and finite values >= 0; otherwise Error(input, "histogram") with the bin.
  double operator()(std::span<const double> p, std::span<const double> q);

 private:
  BinSimilarity similarity_;
  double m_;
  std::size_t bins_ = 0;  ///< size of the buffers below
  std::vector<double> sum_, weight_, d_;
};

}  // namespace faba
