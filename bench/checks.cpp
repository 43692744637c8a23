#include "checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace faba::bench {
namespace {

struct Moments {
  double mean = 0, variance = 0, fourth = 0;
};

Moments moments(std::span<const float> v) {
  Moments m;
  const auto n = double(v.size());
  for (const float x : v) m.mean += double(x) / n;
  for (const float x : v) {
    const double d2 = (double(x) - m.mean) * (double(x) - m.mean);
    m.variance += d2 / n;
    m.fourth += d2 * d2 / n;
  }
  return m;
}

void velocities(const Swarm& s, std::vector<Check>& out) {
  const bool adapted = s.scene().model == "adapted";
  const double n = adapted ? kAdaptedNoise : kBasicNoise, agents = double(s.scene().agents);
  const double length = norm(kDrift);
  for (const bool along_x : {true, false}) {
    const double drift = along_x ? kDrift.x : kDrift.y, u = drift / length;
    // The last velocity of a cycle is drawn in the second half of the command cycle; speeds of cells are 0
    // ... n.
    const double mean = adapted ? -u * n / 2 : -drift;
    const double variance = n * (n + 1) / 3 + (adapted ? u * u * n * (n + 2) / 12 : 0);
    const Moments m = moments(s.world().state().agents[along_x ? "vx" : "vy"]);
    out.push_back({along_x ? "mean vx" : "mean vy", m.mean, mean, 5 * std::sqrt(variance / agents)});
    out.push_back({along_x ? "var vx" : "var vy", m.variance, variance,
                   5 * std::sqrt((m.fourth - m.variance * m.variance) / agents)});
  }
}

void headings(const Swarm& s, std::vector<Check>& out) {
  // Means over exp(kappa cos a): sums over equally spaced angles converge faster than any power of the number
  // of angles.
  double z = 0, c = 0, c2 = 0;
  for (int i = 0; i < 4096; ++i) {
    const double cosine = std::cos(2 * std::numbers::pi * i / 4096), w = std::exp(alignment() * (cosine - 1));
    z += w;
    c += w * cosine;
    c2 += w * cosine * cosine;
  }
  const double expected = 1 - c / z, sd = std::sqrt(c2 / z - (c / z) * (c / z));
  double sum = 0;
  for (const float ux : s.world().state().agents["ux"]) sum += 1 - double(ux);
  const auto n = double(s.scene().agents);
  out.push_back({"1 - <cos>", sum / n, expected, 5 * sd / std::sqrt(n) + 1e-3 * expected});
}

}  // namespace

double alignment() { return 1e-15 * kField / (1.380649e-23 * 298.15); }

std::vector<Check> checks(const Swarm& s) {
  std::vector<Check> out;
  s.scene().model == "dipole" ? headings(s, out) : velocities(s, out);
  const auto x = s.world().state().agents["x"], y = s.world().state().agents["y"];
  const WorldParts& parts = s.world().parts();
  double outside = 0;
  for (std::size_t i = 0; i < x.size(); ++i) outside += !(parts.arena->depth({x[i], y[i]}) >= 0);
  out.push_back({"outside", outside, 0, 0});
  if (s.scene().exclusive()) {
    const Grid g = parts.arena->grid();
    std::vector<std::int32_t> home;
    for (std::size_t i = 0; i < x.size(); ++i) home.push_back(g.index(x[i], y[i]));
    std::sort(home.begin(), home.end());
    const auto distinct = std::unique(home.begin(), home.end()) - home.begin();
    out.push_back({"occupied sites", double(distinct), double(x.size()), 0});
  }
  return out;
}

}  // namespace faba::bench
