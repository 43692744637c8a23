#include "study/steering/metric_list.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/toml.h"

namespace faba {
namespace {

constexpr const char *kReaching = "Reaching the setpoint", *kStaying = "Holding the setpoint",
                     *kPath = "Path", *kDispersion = "Dispersion at the last frame", *kCommand = "Command";

using M = Metrics;

// To add a metric: add its member and definition to metrics.h, its computation to metrics.cpp, and an entry
// here.
constexpr MetricInfo kMetrics[] = {
    {.key = "setpoints_reached",
     .group = kReaching,
     .name = "Setpoints reached",
     .meaning = "distance within the tolerance; without one, within the settling band",
     .unit = "",
     .count = true,
     .value = &M::setpoints_reached},
    {.key = "initial_error_px",
     .group = kReaching,
     .name = "Initial error",
     .meaning = "distance to the setpoint in the first frame with a setpoint",
     .unit = "px",
     .in_um = "µm",
     .value = &M::initial_error_px},
    {.key = "settling_time_s",
     .group = kReaching,
     .name = "Settling time",
     .meaning = "time until the last entry into the settling band",
     .unit = "s",
     .compared = true,
     .value = &M::settling_time_s},
    {.key = "settling_band_px",
     .group = kReaching,
     .name = "Settling band",
     .meaning = "the larger of 5 % of the initial error and 10 px",
     .unit = "px",
     .in_um = "µm",
     .value = &M::settling_band_px},
    {.key = "rise_time_s",
     .group = kReaching,
     .name = "Rise time",
     .meaning = "from 90 % to 10 % of the initial error, first setpoint",
     .unit = "s",
     .compared = true,
     .value = &M::rise_time_s},
    {.key = "overshoot_percent",
     .group = kReaching,
     .name = "Overshoot",
     .meaning = "beyond the first setpoint, relative to the initial error",
     .unit = "%",
     .compared = true,
     .value = &M::overshoot_percent},
    {.key = "steady_rms_px",
     .group = kStaying,
     .name = "Steady-state error",
     .meaning = "rms distance over the last third of the frames",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::steady_rms_px},
    {.key = "steady_max_px",
     .group = kStaying,
     .name = "Largest distance",
     .meaning = "over the last third of the frames",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::steady_max_px},
    {.key = "final_distance_px",
     .group = kStaying,
     .name = "Final distance",
     .meaning = "at the last frame",
     .unit = "px",
     .in_um = "µm",
     .value = &M::final_distance_px},
    {.key = "iae_px_s",
     .group = kStaying,
     .name = "IAE",
     .meaning = "integral of the distance over time",
     .unit = "px s",
     .in_um = "µm s",
     .compared = true,
     .value = &M::iae_px_s},
    {.key = "itae_px_s2",
     .group = kStaying,
     .name = "ITAE",
     .meaning = "integral of time × distance",
     .unit = "px s²",
     .in_um = "µm s²",
     .compared = true,
     .value = &M::itae_px_s2},
    {.key = "path_length_px",
     .group = kPath,
     .name = "Path length",
     .meaning = "of the centroid, including jitter",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::path_length_px},
    {.key = "cross_track_rms_px",
     .group = kPath,
     .name = "Cross-track error, rms",
     .meaning = "root mean square of the distance to the route, after the first setpoint",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::cross_track_rms_px},
    {.key = "cross_track_95_px",
     .group = kPath,
     .name = "Cross-track error, 95 %",
     .meaning = "95 % quantile of the distance to the route",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::cross_track_95_px},
    {.key = "sigma_x_px",
     .group = kDispersion,
     .name = "σx",
     .meaning = "standard deviation of the cell positions along x",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::sigma_x_px},
    {.key = "sigma_y_px",
     .group = kDispersion,
     .name = "σy",
     .meaning = "standard deviation of the cell positions along y",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::sigma_y_px},
    {.key = "rms_radius_px",
     .group = kDispersion,
     .name = "RMS radius",
     .meaning = "root-mean-square distance from the centroid",
     .unit = "px",
     .in_um = "µm",
     .compared = true,
     .value = &M::rms_radius_px},
    {.key = "control_effort_a2_s",
     .group = kCommand,
     .name = "Control effort",
     .meaning = "sum over the coils of the integral of I²",
     .unit = "A² s",
     .compared = true,
     .value = &M::control_effort_a2_s},
    {.key = "total_variation_a",
     .group = kCommand,
     .name = "Total variation of the currents",
     .meaning = "sum of the changes between frames",
     .unit = "A",
     .value = &M::total_variation_a},
    {.key = "total_variation_ut",
     .group = kCommand,
     .name = "Total variation of the field",
     .meaning = "sum of the changes between frames",
     .unit = "µT",
     .compared = true,
     .value = &M::total_variation_ut},
    {.key = "limited_fraction",
     .group = kCommand,
     .name = "Limited",
     .meaning = "fraction of the frames with a clipped command",
     .unit = "%",
     .shown = 100,
     .compared = true,
     .value = &M::limited_fraction}};

// Of trials of a study only: a recorded run does not contain what they need.
constexpr MetricInfo kTrialMetrics[] = {{.key = "coil_heat_w",
                                         .group = kCommand,
                                         .name = "Heat of the coils",
                                         .meaning = "mean over the run, all coils",
                                         .unit = "W",
                                         .compared = true,
                                         .value = &M::coil_heat_w},
                                        {.key = "keep_out_fraction",
                                         .group = kPath,
                                         .name = "Mean in a forbidden region",
                                         .meaning = "fraction of the frames",
                                         .unit = "%",
                                         .shown = 100,
                                         .compared = true,
                                         .value = &M::keep_out_fraction},
                                        {.key = "keep_out_cells",
                                         .group = kPath,
                                         .name = "Cells in a forbidden region",
                                         .meaning = "mean fraction",
                                         .unit = "%",
                                         .shown = 100,
                                         .compared = true,
                                         .value = &M::keep_out_cells}};

}  // namespace

std::span<const MetricInfo> metric_list() { return kMetrics; }

std::vector<const MetricInfo*> compared_metrics() {
  std::vector<const MetricInfo*> all;
  for (const std::span<const MetricInfo> list :
       {std::span<const MetricInfo>(kMetrics), std::span<const MetricInfo>(kTrialMetrics)})
    for (const MetricInfo& m : list)
      if (m.compared) all.push_back(&m);
  return all;
}

const MetricInfo& metric(std::string_view key) {
  for (const MetricInfo& m : kMetrics)
    if (m.key == key) return m;
  for (const MetricInfo& m : kTrialMetrics)
    if (m.key == key) return m;
  throw Error(Errc::internal, std::string(key), "unknown metric");
}

nlohmann::ordered_json metrics_json(const Metrics& m) {
  const auto number = [](const std::optional<double>& v) {
    return v && std::isfinite(*v) ? Json(*v) : Json();
  };
  Json j = {{"frames", m.frames},
            {"duration_s", m.duration_s},
            {"setpoints", m.setpoints},
            {"metrics_source", m.source},
            {"dispersion_px", {number(m.sigma_x_px), number(m.sigma_y_px)}}};
  for (const MetricInfo& one : kMetrics)
    if (one.count)
      j[one.key] = std::uint64_t((m.*one.value).value_or(0));
    else if (one.value != &M::sigma_x_px && one.value != &M::sigma_y_px)
      j[one.key] = number(m.*one.value);
  return j;
}

}  // namespace faba
