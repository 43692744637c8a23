#include "study/pages/latency_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/table.h"

namespace faba {
namespace {

constexpr double kShortest = 0.05, kLongest = 2000;  // ms, ends of the axis
constexpr int kLatencyBins = 92;                     // 20 a decade

// Frames whose latency lies in each bin, as a staircase; the ends take what lies beyond.
Line histogram(std::span<const double> ms, std::string label) {
  Line line{
      .x = {}, .y = std::vector<double>(kLatencyBins + 1, 0.0), .label = std::move(label), .held = true};
  const double step = std::log(kLongest / kShortest) / kLatencyBins;
  for (int i = 0; i <= kLatencyBins; ++i) line.x.push_back(kShortest * std::exp(step * i));
  for (const double v : ms)
    if (std::isfinite(v)) {
      const double at = std::floor(std::log(std::max(v, kShortest) / kShortest) / step);
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
  plot.x.lo = kShortest;
  plot.x.hi = kLongest;
  plot.x.logarithmic = true;
  plot.y.label = "frames";
  plot.y.lo = 0;
  plot.description = "Histogram of how late pictures and commands were";
  plot.inlined = true;
  plot.add(Rule{.at = 1e3 * frame_s, .label = "one frame"});
  plot.add(histogram(table.column("arrival_ms"), "from mid-exposure to the program"));
  plot.add(histogram(table.column("command_ms"), "from there to the coils"));
  return Figure{"Latency",
                "How long each picture took from the middle of its exposure to the program, and the command "
                "that came of it "
                "from there until the device had taken the voltages. What lies beyond an end of the axis is "
                "counted there.",
                std::move(plot)};
}

}  // namespace faba
