#include "study/pages/latency_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/table.h"

namespace faba {
namespace {

constexpr double kAxisLow = 0.05, kAxisHigh = 2000;  // ms, limits of the axis
constexpr int kLatencyBins = 92;                     // 20 per decade

// Histogram of latencies as a staircase; values outside the axis are counted in the first or last bin.
Line latency_histogram(std::span<const double> ms, std::string label) {
  Line line{
      .x = {}, .y = std::vector<double>(kLatencyBins + 1, 0.0), .label = std::move(label), .stairs = true};
  const double step = std::log(kAxisHigh / kAxisLow) / kLatencyBins;
  for (int i = 0; i <= kLatencyBins; ++i) line.x.push_back(kAxisLow * std::exp(step * i));
  for (const double v : ms)
    if (std::isfinite(v)) {
      const double at = std::floor(std::log(std::max(v, kAxisLow) / kAxisLow) / step);
      line.y[std::size_t(std::clamp(at, 0.0, double(kLatencyBins - 1)))] += 1;
    }
  return line;
}

}  // namespace

std::optional<Figure> latency_figure(const std::filesystem::path& run_dir, double frame_s) {
  std::error_code ec;
  const auto file = run_dir / "latency.csv";
  if (!std::filesystem::exists(file, ec)) return {};
  const Table table = read_table(file, LastLine::drop);
  if (table.size() == 0) return {};
  Plot plot;
  plot.x.label = "latency (ms)";
  plot.x.lo = kAxisLow;
  plot.x.hi = kAxisHigh;
  plot.x.logarithmic = true;
  plot.y.label = "frames";
  plot.y.lo = 0;
  plot.y.ticks = Ticks::integers;
  plot.description = "Histogram of the latencies of frames and commands";
  plot.inlined = true;
  plot.add(Rule{.at = 1e3 * frame_s, .label = "one frame"});
  plot.add(latency_histogram(table.column("arrival_ms"), "mid-exposure to arrival of the frame"));
  plot.add(latency_histogram(table.column("command_ms"), "arrival of the frame to the coils"));
  return Figure{
      "Latency",
      "Latency of each frame from the middle of its exposure to its arrival in the program, and of its "
      "command from this arrival until the device has accepted the voltages. Values outside the axis are "
      "counted in the first or last bin.",
      std::move(plot)};
}

}  // namespace faba
