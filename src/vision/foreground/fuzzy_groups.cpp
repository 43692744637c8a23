#include "vision/foreground/fuzzy_groups.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace faba {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kTolerance = 1e-5;  // fraction of the total spread; convergence limit of the centroids

double squared(Vec2 v) { return dot(v, v); }

struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(Vec2 p, double w) {
    n += w;
    x += w * p.x;
    y += w * p.y;
    xx += w * p.x * p.x;
    xy += w * p.x * p.y;
    yy += w * p.y * p.y;
  }
  Vec2 mean() const { return {x / n, y / n}; }
  Mat2 cov() const {
    const Vec2 m = mean();
    return {std::max(0.0, xx / n - m.x * m.x), xy / n - m.x * m.y, std::max(0.0, yy / n - m.y * m.y)};
  }
};

FuzzyGroup single_group(const std::vector<WeightedPosition>& positions) {
  Sums s;
  for (const auto& p : positions) s.add(p.at, p.weight);
  return {s.mean(), s.cov(), 1};
}

// Computes the memberships into `u`, which has the size of groups.
void compute_memberships(const std::vector<FuzzyGroup>& groups, Vec2 at, std::vector<double>& u) {
  double sum = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const double d2 = std::max(squared(at - groups[k].centroid), 1e-300);
    u[k] = 1 / d2;
    sum += u[k];
  }
  if (!std::isfinite(sum)) sum = std::numeric_limits<double>::max();
  for (double& v : u) v = std::min(1.0, v / sum);
}

// Iterates the centroids to convergence.
void iterate_centroids(const std::vector<WeightedPosition>& positions, std::vector<FuzzyGroup>& groups,
                       double spread2) {
  std::vector<double> u(groups.size());
  for (int round = 0; round < kMaxIterations; ++round) {
    std::vector<Sums> sums(groups.size());
    std::vector<double> share(groups.size());
    double total = 0;
    for (const auto& p : positions) {
      compute_memberships(groups, p.at, u);
      total += p.weight;
      for (std::size_t k = 0; k < groups.size(); ++k) {
        sums[k].add(p.at, p.weight * u[k] * u[k]);
        share[k] += p.weight * u[k];
      }
    }
    double moved = 0;
    for (std::size_t k = 0; k < groups.size(); ++k) {
      if (!(sums[k].n > 0)) continue;
      moved = std::max(moved, squared(sums[k].mean() - groups[k].centroid));
      groups[k] = {sums[k].mean(), sums[k].cov(), share[k] / total};
    }
    if (moved <= kTolerance * kTolerance * spread2) break;
  }
}

// Splits the widest group (by weight times variance) into two, displaced by one standard deviation in both
// directions of its main axis.
std::vector<FuzzyGroup> split_widest(std::vector<FuzzyGroup> groups) {
  const auto widest =
      std::max_element(groups.begin(), groups.end(), [](const FuzzyGroup& a, const FuzzyGroup& b) {
        return a.share * (a.cov.xx + a.cov.yy) < b.share * (b.cov.xx + b.cov.yy);
      });
  const Mat2 c = widest->cov;
  const double half = 0.5 * (c.xx - c.yy), apart = std::sqrt(half * half + c.xy * c.xy);
  const double large = 0.5 * (c.xx + c.yy) + apart;
  Vec2 axis = half >= 0 ? Vec2{half + apart, c.xy} : Vec2{c.xy, apart - half};
  const double length = norm(axis);
  axis = length > 0 ? 1 / length * axis : Vec2{1, 0};
  const Vec2 step = std::sqrt(std::max(0.0, large)) * axis;
  FuzzyGroup other = *widest;
  widest->centroid = widest->centroid + step;
  other.centroid = other.centroid - step;
  groups.push_back(other);
  return groups;
}

struct Validity {
  bool separated = true;
  double xie_beni = 0;
};

// Validity with hard assignment of each position to its nearest group.
Validity validity_of(const std::vector<WeightedPosition>& positions, const std::vector<FuzzyGroup>& groups,
                     const FuzzyGroupOptions& o) {
  std::vector<Sums> hard_groups(groups.size());
  std::vector<double> u(groups.size());
  double within = 0, total = 0, nearest = std::numeric_limits<double>::max();
  for (const auto& p : positions) {
    compute_memberships(groups, p.at, u);
    const auto k = std::size_t(std::max_element(u.begin(), u.end()) - u.begin());
    hard_groups[k].add(p.at - groups[k].centroid, p.weight);
    total += p.weight;
    for (std::size_t i = 0; i < groups.size(); ++i)
      within += p.weight * u[i] * u[i] * squared(p.at - groups[i].centroid);
  }
  Validity v;
  for (std::size_t a = 0; a < groups.size(); ++a) {
    if (hard_groups[a].n < o.least_share * total) return {false, 0};
    for (std::size_t b = a + 1; b < groups.size(); ++b) {
      if (hard_groups[b].n < o.least_share * total) return {false, 0};
      const Vec2 apart =
          groups[a].centroid + hard_groups[a].mean() - groups[b].centroid - hard_groups[b].mean();
      const double d2 = squared(apart);
      const auto along = [&](const Mat2& c) {
        return (c.xx * apart.x * apart.x + 2 * c.xy * apart.x * apart.y + c.yy * apart.y * apart.y) / d2;
      };
      const double spread2 = 0.5 * (along(hard_groups[a].cov()) + along(hard_groups[b].cov()));
      if (!(d2 > o.separation * o.separation * spread2)) v.separated = false;
      nearest = std::min(nearest, squared(groups[a].centroid - groups[b].centroid));
    }
  }
  v.xie_beni = within / (total * nearest);
  return v;
}

}  // namespace

std::vector<double> memberships(const std::vector<FuzzyGroup>& groups, Vec2 at) {
  std::vector<double> u(groups.size());
  compute_memberships(groups, at, u);
  return u;
}

std::vector<FuzzyGroup> fuzzy_groups(const std::vector<WeightedPosition>& positions,
                                     const FuzzyGroupOptions& o) {
  double total = 0;
  for (const auto& p : positions) total += p.weight;
  if (!(total > 0)) return {};
  std::vector<FuzzyGroup> groups{single_group(positions)}, best = groups;
  const double spread2 = groups[0].cov.xx + groups[0].cov.yy;
  double best_index = std::numeric_limits<double>::max();
  const auto most = std::min<std::size_t>(std::size_t(o.count > 0 ? o.count : o.most), positions.size());
  while (groups.size() < most && spread2 > 0) {
    groups = split_widest(groups);
    iterate_centroids(positions, groups, spread2);
    if (o.count > 0) {
      best = groups;
      continue;
    }
    const Validity v = validity_of(positions, groups, o);
    if (v.separated && v.xie_beni < best_index) {
      best_index = v.xie_beni;
      best = groups;
    }
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const FuzzyGroup& a, const FuzzyGroup& b) { return a.share > b.share; });
  return best;
}

std::vector<WeightedPosition> binned(const std::vector<WeightedPosition>& positions, int cells) {
  if (positions.empty()) return {};
  Vec2 low = positions[0].at, high = low;
  for (const auto& p : positions) {
    low = {std::min(low.x, p.at.x), std::min(low.y, p.at.y)};
    high = {std::max(high.x, p.at.x), std::max(high.y, p.at.y)};
  }
  const double side = std::max(high.x - low.x, high.y - low.y) / cells;
  if (!(side > 0)) {
    double total = 0;
    for (const auto& p : positions) total += p.weight;
    return {{low, total}};
  }
  std::vector<Sums> sums(std::size_t(cells) * std::size_t(cells));
  const auto index = [&](double v) { return std::size_t(std::clamp(int(v / side), 0, cells - 1)); };
  for (const auto& p : positions)
    sums[index(p.at.y - low.y) * std::size_t(cells) + index(p.at.x - low.x)].add(p.at, p.weight);
  std::vector<WeightedPosition> out;
  for (const Sums& s : sums)
    if (s.n > 0) out.push_back({s.mean(), s.n});
  return out;
}

}  // namespace faba
