#include "study/tracks/track_features.h"

#include <cmath>

#include "core/statistics.h"
#include "core/units.h"
#include "core/vec.h"
#include "study/tracks/track_sums.h"

namespace faba {
namespace {

Vec2 between(const TrackPoint& a, const TrackPoint& b) { return {b.x_px - a.x_px, b.y_px - a.y_px}; }

// Sums over consecutive displacements of the interval.
struct IntervalMotion {
  double length_px = 0, time_s = 0, turned_rad = 0, turned_s = 0;
};

IntervalMotion interval_motion(const Track& track, double frame_s, int interval) {
  IntervalMotion m;
  const std::vector<int> slots = slots_of(track, frame_s);
  const auto step = std::size_t(interval);
  Vec2 last;
  bool has_last = false;
  for (std::size_t i = 0; i + step < slots.size(); i += step) {
    const bool seen = slots[i] >= 0 && slots[i + step] >= 0;
    if (seen) {
      const TrackPoint &p = track.points[std::size_t(slots[i])],
                       &q = track.points[std::size_t(slots[i + step])];
      const Vec2 d = between(p, q);
      m.length_px += norm(d);
      m.time_s += q.t_s - p.t_s;
      if (has_last) {
        m.turned_rad += std::fabs(std::atan2(last.x * d.y - last.y * d.x, dot(last, d)));
        m.turned_s += q.t_s - p.t_s;
      }
      last = d;
    }
    has_last = seen;
  }
  return m;
}

}  // namespace

TrackFeatures features_of(const Track& track, double frame_s, int interval) {
  TrackFeatures f;
  f.fill(kNaN);
  if (track.points.empty()) return f;
  const auto at = [&](TrackFeature which) -> double& { return f[std::size_t(which)]; };
  double path = 0, snr = track.points.front().snr;
  for (std::size_t i = 1; i < track.points.size(); ++i) {
    path += norm(between(track.points[i - 1], track.points[i]));
    snr += track.points[i].snr;
  }
  const double duration = track.points.back().t_s - track.points.front().t_s;
  const double displacement = norm(between(track.points.front(), track.points.back()));
  const IntervalMotion m = interval_motion(track, frame_s, interval);
  at(TrackFeature::points) = double(track.points.size());
  at(TrackFeature::snr) = snr / double(track.points.size());
  at(TrackFeature::duration) = duration;
  at(TrackFeature::displacement) = displacement;
  at(TrackFeature::path) = path;
  if (path > 0) at(TrackFeature::straightness) = displacement / path;
  if (m.time_s > 0)
    at(TrackFeature::speed) = m.length_px / m.time_s;
  else if (duration > 0)
    at(TrackFeature::speed) = displacement / duration;
  if (m.turned_s > 0) at(TrackFeature::turning) = m.turned_rad * kDegreesPerRadian / m.turned_s;
  return f;
}

}  // namespace faba
