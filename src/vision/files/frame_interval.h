#pragma once
#include <optional>
#include <span>

namespace faba {

/// Time between two frames of a recording.
struct FrameInterval {
  double s = 0;
  bool regular = true;  ///< all frames are at equal times, up to a fifth of the interval
};

/// The mean of the differences of `times` without gaps, which are longer than 1.5 times the median: dropped
/// frames do not change it, and rounded times do not bias it. Empty for fewer than two times, or if they do
/// not increase.
std::optional<FrameInterval> frame_interval(std::span<const double> times);

}  // namespace faba
