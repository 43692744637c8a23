#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "study/stats/statistics.h"

namespace faba {

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
  if (v.size() < 4) return kNaN;
  double mean = 0, square = 0;
  for (const double x : v) mean += x / double(v.size());
  for (const double x : v) square += (x - mean) * (x - mean);
  return std::sqrt(square * double(v.size() - 1) / double(v.size()));
}

}  // namespace faba
