#include "vision/files/frame_interval.h"

#include <algorithm>
#include <vector>

#include "core/statistics.h"

namespace faba {

std::optional<FrameInterval> frame_interval(std::span<const double> times) {
  constexpr double kGap = 1.5, kRegular = 0.2;  // relative to the interval
  if (times.size() < 2) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const double middle = median(steps);
  if (!(middle > 0)) return std::nullopt;
  double sum = 0, count = 0;
  for (const double step : steps) {
    if (step > kGap * middle) continue;
    sum += step;
    ++count;
  }
  const double mean = sum / count;
  if (!(mean > 0)) return std::nullopt;
  const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
  return FrameInterval{mean, *longest - mean <= kRegular * mean && mean - *shortest <= kRegular * mean};
}

}  // namespace faba
