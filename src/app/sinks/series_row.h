#pragma once
#include <string>
#include <vector>

#include "app/sinks/series_columns.h"

namespace faba {

/// The rows of series.csv of one run: its columns, and their values in every control cycle.
class SeriesRow {
 public:
  explicit SeriesRow(SinkContext c);

  std::vector<std::string> names() const;
  /// One value for each name; NaN: no value, such as the distance without a setpoint.
  std::vector<double> values(const Tick& t) const;

 private:
  SinkContext c_;
  std::vector<SeriesColumn> columns_;
};

}  // namespace faba
