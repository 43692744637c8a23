#pragma once
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/steering/metrics.h"

namespace faba {

/// Description of a metric for JSON, report tables and controller studies. The exact definition is that of
/// the member in metrics.h.
struct MetricInfo {
  const char* key;              ///< in JSON; ends with the unit
  const char* group;            ///< heading in the report table
  const char* name;             ///< in tables
  const char* meaning;          ///< short description in tables
  const char* unit;             ///< displayed unit
  double shown = 1;             ///< factor from the value to the displayed unit
  const char* in_um = nullptr;  ///< unit after multiplication with the image scale; null: not a length
  bool count = false;           ///< an integer, in JSON 0 where it is empty
  bool compared = false;        ///< listed in controller studies, with an interval over seeds
  std::optional<double> Metrics::*value;
};

/// All scalar metrics, by group, in the order of the report.
std::span<const MetricInfo> metric_list();
/// The metrics that are compared in controller studies, also those of trials only.
std::vector<const MetricInfo*> compared_metrics();
/// The entry with this key. Throws Error(internal) when there is no such metric.
const MetricInfo& metric(std::string_view key);

/// frames, duration_s, setpoints and metrics_source, and every metric under its key, null where it is empty.
/// The two standard deviations are `dispersion_px` = [sigma_x, sigma_y].
nlohmann::ordered_json metrics_json(const Metrics& metrics);

}  // namespace faba
