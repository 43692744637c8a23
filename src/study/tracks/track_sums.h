#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "study/stats/statistics.h"

namespace faba {

/// Sums over pairs of sightings one lag apart.
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
  /// Mean-square displacement about the mean one.
  double msd() const { return (rr - (dx * dx + dy * dy) / n) / n; }
};

/// Sums over pairs of displacements: of `over` frames, the second beginning `apart` frames after the first.
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

/// Sums over every 20th track: the jackknife leaves out one group after the other.
struct TrackGroup {
  std::vector<LagSums> lags;
  /// One for each number of frames that a displacement takes; the pause between two is as long.
  std::vector<ProductSums> kept;
  std::vector<ProductSums> memory;  ///< displacements of one frame, two frames apart or more
  SpeedSums speed;
  TurnSums turn;
  double tracks = 0;
};

/// delete-one jackknife over the groups that hold tracks: value(left out) for each of them.
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
