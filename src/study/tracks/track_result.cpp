#include "study/tracks/track_result.h"

#include <cmath>

namespace faba {

SupportedWalk supported_walk(const TrackSummary& s) {
  if (s.msd.size() < 2) return SupportedWalk::none;
  return s.persists ? SupportedWalk::persistent : SupportedWalk::diffusion;
}

const MsdMisfit& misfit_of(const TrackSummary& s) {
  return s.persists ? s.persistent_misfit : s.diffusion_misfit;
}

double mean_order(const TrackSummary& s) {
  double order = 0, n = 0;
  for (std::size_t i = 0; i < s.order_in_time.size(); ++i) {
    if (!std::isfinite(s.order_in_time[i])) continue;
    order += s.order_in_time[i] * s.count_in_time[i];
    n += s.count_in_time[i];
  }
  return n > 0 ? order / n : std::nan("");
}

}  // namespace faba
