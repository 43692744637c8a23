#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/sweep/result_store.h"
#include "study/sweep/round_file.h"

namespace faba {

/// The results of a study as a table, one row for each task that has a result: number of the task, round,
/// labels, values. Labels and values that a task does not have are empty (CSV) or NaN (HDF5).
class ResultTable {
 public:
  /// `value_names`: names of the first values; the others are value_N. `round_of` makes a planned round.
  ResultTable(const ResultStore& store, std::vector<PlannedRound> planned,
              const std::function<Round(const PlannedRound&)>& round_of,
              const std::vector<std::string>& value_names);
  /// Throws Error(internal).
  void write_csv(const std::filesystem::path& file) const;
  /// Tables `task` and `round` (from 1), `values` (task x value), and for each label `label_K` with its name
  /// in the attribute `name`: numbers, or indices of words in the attribute `words`, a JSON list. The
  /// attribute `values` of the file is a JSON list of the names of the values. Throws Error(internal).
  void write_hdf5(const std::filesystem::path& file) const;
  std::uint64_t rows() const { return rows_; }

 private:
  struct Label {
    std::string name;
    bool numeric = true;
    std::vector<std::string> words = {};
  };
  struct Row {
    std::uint64_t task = 0, round = 0;
    std::vector<TaskLabel> labels;
    std::span<const double> values;
  };
  void each_row(const std::function<void(const Row&)>& take) const;
  void add_label(const TaskLabel& label);
  double number_of(const Row& row, const Label& label) const;

  const ResultStore& store_;
  std::vector<PlannedRound> planned_;
  std::vector<Round> made_;
  std::vector<Label> labels_;
  std::vector<std::string> values_;
  std::uint64_t rows_ = 0;
};

}  // namespace faba
