#include "study/data/series.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace faba {
namespace {

struct Renamed {
  const char* old_name;
  const char* name;
};
// Column names of version 0.1.
constexpr std::array kSimulationNames = {
    Renamed{"centroid_x_px", "true_centroid_x_px"},     Renamed{"centroid_y_px", "true_centroid_y_px"},
    Renamed{"sigma_x_px", "true_sigma_x_px"},           Renamed{"sigma_y_px", "true_sigma_y_px"},
    Renamed{"rms_radius_px", "true_rms_radius_px"},     Renamed{"estimate_x_px", "estimated_centroid_x_px"},
    Renamed{"estimate_y_px", "estimated_centroid_y_px"}};
constexpr std::array kBenchNames = {
    Renamed{"estimate_x_px", "estimated_centroid_x_px"}, Renamed{"estimate_y_px", "estimated_centroid_y_px"},
    Renamed{"sigma_x_px", "estimated_sigma_x_px"}, Renamed{"sigma_y_px", "estimated_sigma_y_px"}};

}  // namespace

Series read_series(const std::filesystem::path& path) {
  const Table read = read_table(path, LastLine::drop);
  std::error_code ec;
  const bool bench = std::filesystem::exists(path.parent_path() / "commands.csv", ec);
  const std::span<const Renamed> renamed = bench ? std::span<const Renamed>(kBenchNames) : kSimulationNames;
  std::vector<std::string> names = read.names();
  std::vector<std::vector<double>> columns;
  for (std::string& name : names) {
    const auto values = read.column(name);
    columns.emplace_back(values.begin(), values.end());
    for (const Renamed& r : renamed)
      if (name == r.old_name) name = r.name;
  }
  return {read.source(), std::move(names), std::move(columns), read.last_line_cut()};
}

SwarmColumns swarm_columns(const Series& series) {
  const std::string source = series.has("true_centroid_x_px") ? "true" : "estimated";
  SwarmColumns c{.source = source,
                 .x = series.column(source + "_centroid_x_px"),
                 .y = series.column(source + "_centroid_y_px"),
                 .sigma_x = series.column(source + "_sigma_x_px"),
                 .sigma_y = series.column(source + "_sigma_y_px"),
                 .rms_radius = {}};
  const auto recorded = series.find("true_rms_radius_px");
  c.rms_radius.assign(recorded.begin(), recorded.end());
  for (std::size_t k = c.rms_radius.size(); k < c.sigma_x.size(); ++k)
    c.rms_radius.push_back(std::sqrt(c.sigma_x[k] * c.sigma_x[k] + c.sigma_y[k] * c.sigma_y[k]));
  return c;
}

}  // namespace faba
