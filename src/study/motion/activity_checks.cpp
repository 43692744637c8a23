#include "study/motion/activity_checks.h"

#include <algorithm>

#include <fmt/format.h>

#include "study/motion/direction_text.h"
#include "study/motion/segments.h"

namespace faba {

std::optional<Warning> light_warning(const LightChange& light, int px_side, double threshold_px) {
  const double imitated = px_side * light.imitated_px();
  if (imitated <= threshold_px) return std::nullopt;
  return Warning{
      "light", "the brightness changes from frame to frame, which counts as motion everywhere",
      fmt::format("the mean change is that of a displacement by {:.2g} px; the threshold is {:.2g} px",
                  imitated, threshold_px),
      "use a constant light and exposure, or divide each frame by its mean"};
}

std::optional<Warning> opposite_warning(const Signature& s, double direction_deg) {
  constexpr double kPreferred = 2;  // assumed: flow without a preferred direction gives 1
  // The smaller of two opposite flows in each pair, along the direction and across it.
  double along = 0, across = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const auto opposite = [&](double deg) {
      return std::min(s.amount(k, s.nearest_deg(deg)), s.amount(k, s.nearest_deg(deg + 180)));
    };
    along += opposite(direction_deg);
    across += opposite(direction_deg + 90);
  }
  if (!(along > kPreferred * across)) return std::nullopt;
  return Warning{
      "populations",
      "cells move along the direction and against it at the same time, and their flows cancel: cells of both "
      "polarities, or a part of them does not turn",
      fmt::format("flow in both directions along the axis is {:.1f} times that across it", along / across),
      "measure the speeds with faba track"};
}

std::optional<Warning> no_response_warning(const Response& r) {
  constexpr double kMany = 0.5;  // fraction of the cells, assumed
  if (r.responds) return std::nullopt;
  if (r.other_direction_deg)
    return Warning{"direction",
                   "no response in the given direction, but the velocity of the cells changes in another one",
                   fmt::format("the change has the direction {}; the given direction is {}",
                               direction_text(*r.other_direction_deg), direction_text(r.direction_deg)),
                   "check the direction; --direction and study files count clockwise: 90 is down; cells of "
                   "one polarity swim along the "
                   "field, of the other against it",
                   Quality::poor};
  if (r.fraction && r.fraction->ci90[1] > kMany)
    return Warning{"timing",
                   "no response at the given time, but many cells move along the direction: they may have "
                   "responded before or not turned",
                   fmt::format("up to {:.0f} % of them", 100 * r.fraction->ci90[1]),
                   "check --reversal and --from"};
  return std::nullopt;
}

std::optional<Warning> edge_warning(const Response& r) {
  // Cells on the dark line of the edge count for 0.55 to 1 of others (tests). Where they have a tenth of the
  // contrast, they are at most 17 % of the cells, and the fraction is too large by at most 0.07: below the
  // 0.1 that is required of it. Assumed.
  constexpr double kMuch = 0.1;
  if (!r.responds || !r.fraction || r.still_at_edge < kMuch) return std::nullopt;
  return Warning{
      "edge",
      "objects stay beside the edge of the drop, where cells are difficult to distinguish from the "
      "edge: the responding fraction can be wrong by more than its interval",
      fmt::format("they have {:.0f} % of the contrast of all objects", 100 * r.still_at_edge),
      "use a drop in which the cells do not gather at the edge, or crop the video so that the edge "
      "is not in view"};
}

}  // namespace faba
