#pragma once
#include <optional>

namespace faba {

/// An interval of a video, s; `fps` > 0 overrides the frame rate of the video.
struct VideoPart {
  double from_s = 0;
  std::optional<double> to_s = {};
  double fps = 0;
  bool holds(double t_s) const { return t_s >= from_s && (!to_s || t_s <= *to_s); }
  bool ends_before(double t_s) const { return to_s && t_s > *to_s; }
};

}  // namespace faba
