#include "server/shown/row_history.h"

#include <utility>

namespace faba {

void RowHistory::add(std::span<const double> row) {
  if (rows_.size() == most_) {
    const std::size_t half = rows_.size() / 2;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (k < half && k % 2 != 0) continue;
      std::swap(rows_[kept], rows_[k]);
      ++kept;
    }
    rows_.resize(kept);
  }
  rows_.emplace_back(row.begin(), row.end());
}

}  // namespace faba
