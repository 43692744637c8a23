#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace faba {

/// The rows of a series since the start of a run, in bounded memory: when it is full, every second row of the
/// older half is removed, so that the resolution decreases with the age. The first row remains.
class RowHistory {
 public:
  /// `most`: maximum number of rows, at least 4.
  explicit RowHistory(std::size_t most) : most_(most) {}
  void add(std::span<const double> row);
  std::size_t size() const { return rows_.size(); }
  std::span<const double> row(std::size_t k) const { return rows_[k]; }

 private:
  std::size_t most_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace faba
