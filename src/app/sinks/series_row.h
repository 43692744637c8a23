#pragma once
#include <string>
#include <vector>

#include "app/sinks/series_columns.h"

namespace faba {

/// The rows of series.csv of one run: the columns that this run has, and their values turn by turn.
class SeriesRow {
 public:
  explicit SeriesRow(SinkContext c);

  std::vector<std::string> names() const;
  /// One value for each name; NaN stands for "nothing there", such as the distance to no setpoint.
  std::vector<double> values(const Tick& t) const;

 private:
  SinkContext c_;
  std::vector<SeriesColumn> columns_;
};

}  // namespace faba
