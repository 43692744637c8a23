#include "study/motion/segments.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/statistics.h"
#include "core/units.h"

namespace faba {
namespace {

constexpr double kWindow = 0.4, kShortest = 0.5, kGap = 0.3;  // s
constexpr double kOneWay = 0.5, kOfMost = 1.0 / 7, kTurn = 60;
constexpr double kRayleigh = 6.9;  // threshold of n R^2, exceeded with probability exp(-n R^2) = 1e-3

double between(double a, double b) { return std::fabs(std::remainder(a - b, 360)); }
Vec2 unit(double deg) { return {std::cos(deg * kDegree), std::sin(deg * kDegree)}; }

/// Flow and speed of each pair.
struct Pairs {
  std::vector<Vec2> flow;
  std::vector<double> speed;
  double one_way = kOneWay;  ///< smallest fraction of the speed that must be in one direction
};
Pairs pairs_of(const Signature& s, std::optional<double> direction) {
  Pairs p;
  if (direction) p.one_way *= std::cos(45 * kDegree);  // motion within 45 degrees of it counts
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Vec2 flow = s.sum(k);
    p.flow.push_back(direction ? dot(flow, unit(*direction)) * unit(*direction) : flow);
    p.speed.push_back(s.speed(k));
  }
  return p;
}

/// Consecutive pairs [begin, end) with one direction of motion.
struct Run {
  std::size_t begin = 0, end = 0;
  Vec2 sum{0, 0};
};

std::vector<Run> runs_of(const Signature& s, const Pairs& p) {
  const std::size_t n = s.size();
  const double period = n > 1 ? (s.t1_s(n - 1) - s.t0_s(0)) / double(n) : kWindow;
  const auto half = std::max<std::size_t>(1, std::size_t(std::lround(kWindow / period / 2)));
  std::vector<Vec2> flow(n);
  std::vector<double> speed(n), size(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k < half ? 0 : k - half; i < std::min(n, k + half + 1); ++i) {
      flow[k] = flow[k] + p.flow[i];
      speed[k] += p.speed[i];
    }
    size[k] = std::sqrt(dot(flow[k], flow[k]));
  }
  const double most = n > 0 ? *std::max_element(size.begin(), size.end()) : 0;
  std::vector<Run> runs;
  for (std::size_t k = 0; k < n; ++k) {
    if (!(size[k] > p.one_way * speed[k] && size[k] > kOfMost * most)) continue;
    const bool continues = !runs.empty() && s.t0_s(k) - s.t1_s(runs.back().end - 1) < kGap &&
                           between(direction_of(flow[k]), direction_of(runs.back().sum)) < kTurn;
    if (!continues) runs.push_back({k, k, {0, 0}});
    runs.back().end = k + 1;
    runs.back().sum = runs.back().sum + flow[k];
  }
  return runs;
}

bool significantly_directed(const Run& r, const Pairs& p) {
  Vec2 sum{0, 0};
  for (std::size_t k = r.begin; k < r.end; ++k)
    if (const double size = std::sqrt(dot(p.flow[k], p.flow[k])); size > 0)
      sum = sum + (1 / size) * p.flow[k];
  return dot(sum, sum) > kRayleigh * double(r.end - r.begin);
}

/// Start and end where the flow along the direction of the run crosses half of its median, within the
/// neighbouring runs.
MotionSegment trimmed(const Signature& s, const Pairs& p, const Run& r, std::size_t from, std::size_t to) {
  const double direction = direction_of(r.sum);
  const Vec2 d = unit(direction);
  std::vector<double> along(s.size());
  for (std::size_t k = from; k < to; ++k) along[k] = dot(p.flow[k], d);
  std::vector<double> of_run(along.begin() + std::ptrdiff_t(r.begin), along.begin() + std::ptrdiff_t(r.end));
  const double level = median_high(of_run) / 2;
  const std::size_t middle = (r.begin + r.end) / 2;
  // Two consecutive pairs: a single one may be noise.
  const auto moves = [&](std::size_t k) {
    return along[k] >= level &&
           ((k > from && along[k - 1] >= level) || (k + 1 < to && along[k + 1] >= level));
  };
  std::size_t begin = middle, end = middle;
  for (std::size_t k = from; k < middle; ++k)
    if (moves(k)) {
      begin = k;
      break;
    }
  for (std::size_t k = to; k-- > middle;)
    if (moves(k)) {
      end = k;
      break;
    }
  return {s.t0_s(begin), s.t1_s(end), direction};
}

}  // namespace

std::vector<MotionSegment> motion_segments(const Signature& s, std::optional<double> direction_deg) {
  const Pairs p = pairs_of(s, direction_deg);
  std::vector<MotionSegment> segments;
  const std::vector<Run> runs = runs_of(s, p);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& r = runs[i];
    if (!significantly_directed(r, p)) continue;
    // Margin on either side: up to the neighbouring runs, at most a window.
    std::size_t from = r.begin, to = r.end;
    while (from > (i ? runs[i - 1].end : 0) && s.t0_s(r.begin) - s.t0_s(from - 1) < kWindow) --from;
    while (to < (i + 1 < runs.size() ? runs[i + 1].begin : s.size()) &&
           s.t1_s(to) - s.t1_s(r.end - 1) < kWindow)
      ++to;
    const MotionSegment segment = trimmed(s, p, r, from, to);
    if (segment.t1_s - segment.t0_s >= kShortest) segments.push_back(segment);
  }
  return segments;
}

}  // namespace faba
