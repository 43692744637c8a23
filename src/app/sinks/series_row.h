#pragma once
#include <string>
#include <vector>

#include "app/sinks/sinks.h"

namespace faba {

/// What is recorded of every frame: the columns of series.csv (docs/formats/run-directory.md).
class SeriesRow {
 public:
  explicit SeriesRow(SinkContext c) : c_(std::move(c)) {}

  std::vector<std::string> names() const;
  /// One value for each name; NaN stands for "nothing there", such as the distance to no setpoint.
  std::vector<double> values(const Tick& t) const;

 private:
  SinkContext c_;
};

}  // namespace faba
