#pragma once
#include <vector>

namespace faba {

/// A candidate pair of a row and a column with its gain (> 0).
struct PossiblePair {
  int row = 0, column = 0;
  double gain = 0;
};

/// Optimal assignment: each row and each column is in one pair at most, and the sum of the gains is maximal
/// (global optimum, not greedy). Connected components of the candidates are solved separately (maximum
/// weighted matching of LEMON). Element r of the result is the column of row r, or -1. Rows are 0 to rows -
/// 1, columns 0 to columns - 1. Deterministic, also for equal optima.
std::vector<int> best_assignment(int rows, int columns, const std::vector<PossiblePair>& candidates);

}  // namespace faba
