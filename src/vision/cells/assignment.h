#pragma once
#include <vector>

namespace faba {

/// A row and a column that may belong together, and what is gained by it (> 0).
struct PossiblePair {
  int row = 0, column = 0;
  double gain = 0;
};

/// The pairs, each row and each column in one at most, with the largest sum of gains: the best assignment
/// over the whole frame, not the best one by one. Solved for each connected part of the candidates by itself
/// (maximum weighted matching of LEMON). `of_row[r]` of the result is the column of row r, -1 for none. Rows
/// are 0 to rows - 1, columns 0 to columns - 1. Same input, same result, also where several are equally good.
std::vector<int> best_assignment(int rows, int columns, const std::vector<PossiblePair>& candidates);

}  // namespace faba
