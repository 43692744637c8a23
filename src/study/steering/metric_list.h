#pragma once
#include <span>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "study/steering/metrics.h"

namespace faba {

/// What is said of one metric wherever it appears: JSON, tables of reports, studies of controllers. The exact
/// definition stands at the member in metrics.h.
struct MetricInfo {
  const char* key;              ///< in JSON; the unit is part of it
  const char* group;            ///< heading of the report's table
  const char* name;             ///< in tables
  const char* meaning;          ///< in tables, a few words
  const char* unit;             ///< as it is shown
  double shown = 1;             ///< what a value is multiplied by to be in that unit
  const char* in_um = nullptr;  ///< unit when the picture scale multiplies the value; null: not a length
  bool count = false;           ///< a whole number, in JSON 0 where it is empty
  bool compared = false;        ///< studies of controllers give it with an interval over seeds
  std::optional<double> Metrics::*value;
};

/// All metrics that are one number, group by group, in the order of the report.
std::span<const MetricInfo> metric_list();
/// The entry with that key, which must exist.
const MetricInfo& metric(std::string_view key);

/// frames, duration_s, setpoints and metrics_source, and every metric under its key, null for what is empty;
/// except that `dispersion_px` = [sigma_x, sigma_y] stands for the two standard deviations.
nlohmann::ordered_json metrics_json(const Metrics& metrics);

}  // namespace faba
