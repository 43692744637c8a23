#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/statistics.h"
#include "core/vec.h"
#include "study/stats/msd_fit.h"
#include "vision/cells/tracker.h"

namespace faba {

/// Index of the point of a track for each frame time since its first detection; -1: not detected.
inline std::vector<int> slots_of(const Track& track, double frame_s) {
  std::vector<int> slots;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const auto at = std::size_t(std::lround((track.points[i].t_s - track.points[0].t_s) / frame_s));
    if (at > 10000000) break;  // a pause of months in the time stamps
    slots.resize(std::max(slots.size(), at + 1), -1);
    slots[at] = int(i);
  }
  return slots;
}

/// Sums over pairs of detections separated by one lag.
struct LagSums {
  double n = 0, dt = 0, dx = 0, dy = 0, rr = 0;
  LagSums& operator+=(const LagSums& o) {
    n += o.n;
    dt += o.dt;
    dx += o.dx;
    dy += o.dy;
    rr += o.rr;
    return *this;
  }
  LagSums without(const LagSums& o) const { return {n - o.n, dt - o.dt, dx - o.dx, dy - o.dy, rr - o.rr}; }
  /// Mean-square displacement relative to the mean displacement.
  double msd() const { return (rr - (dx * dx + dy * dy) / n) / n; }
};

/// Sums over pairs of displacements of `over` frames, the second starting `apart` frames after the first.
struct ProductSums {
  std::size_t over = 1, apart = 2;
  double n = 0, dot = 0;
};

/// Sums over velocities.
struct VelocitySums {
  Vec2 sum;
  double n = 0, length = 0, xx = 0, xy = 0, yy = 0;
  void take(Vec2 v) {
    sum = sum + v;
    n += 1;
    length += norm(v);
    xx += v.x * v.x;
    xy += v.x * v.y;
    yy += v.y * v.y;
  }
  /// Smaller over larger eigenvalue of the covariance; NaN: too few, or no variance.
  double isotropy() const {
    if (n < 2) return kNaN;
    const double a = xx - sum.x * sum.x / n, b = xy - sum.x * sum.y / n, c = yy - sum.y * sum.y / n;
    const double mean = 0.5 * (a + c), off = std::hypot(0.5 * (a - c), b);
    return mean > 0 ? std::max(0.0, mean - off) / (mean + off) : kNaN;
  }
};

struct SpeedSums {
  double n = 0, v = 0;
};

struct TurnSums {
  double n = 0, size = 0, with_sign = 0;
};

/// Sums over every 20th track: a group of the jackknife.
struct TrackGroup {
  std::vector<LagSums> lags;
  /// One per time scale; the pause between two displacements has the duration of a displacement.
  std::vector<ProductSums> kept;
  std::vector<ProductSums> memory;  ///< displacements of one frame, at least two frames apart
  SpeedSums speed;
  TurnSums turn;
  double tracks = 0;
};

/// Standard error by the delete-one jackknife over the groups with tracks: value(group) is the estimate
/// without that group.
template <class Value>
double jackknife_se(const std::vector<TrackGroup>& groups, const Value& value) {
  std::vector<double> v;
  for (const TrackGroup& g : groups)
    if (g.tracks > 0) v.push_back(value(g));
  return jackknife_se(v);
}

}  // namespace faba
