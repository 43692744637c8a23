#include "study/identify/found_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/data/flow_choice.h"
#include "study/motion/activity.h"

namespace faba {
namespace {

constexpr double kReversal =
    0.25;  // fraction of the range that the swarm must move back to count as a reversal
constexpr double kOnsetLow = 0.05,
                 kOnsetHigh = 0.25;  // fractions of a segment's path: extrapolation to its start

constexpr double kMinDuration = 0.4;     // s: of a constant field
constexpr double kFieldOn = 0.2;         // fraction of the maximum field strength
constexpr double kSameDirection = 0.87;  // cosine of 30 degrees

/// Angle of the principal axis of the points, rad.
double main_axis(const std::vector<Vec2>& p) {
  Vec2 mean;
  for (const Vec2 v : p) mean = mean + (1.0 / double(p.size())) * v;
  Mat2 c;
  for (const Vec2 v : p) {
    const Vec2 d = v - mean;
    c.xx += d.x * d.x;
    c.xy += d.x * d.y;
    c.yy += d.y * d.y;
  }
  return 0.5 * std::atan2(2 * c.xy, c.xx - c.yy);
}

/// Indices of the turning points of q, which end its monotonic sections longer than `least`. Empty when there
/// are no such sections.
std::vector<std::size_t> turning_points(const std::vector<double>& q, double least) {
  std::vector<std::size_t> turns;
  std::size_t lowest = 0, highest = 0;  // of the current section
  int sign = 0;
  for (std::size_t i = 1; i < q.size(); ++i) {
    if (q[i] < q[lowest]) lowest = i;
    if (q[i] > q[highest]) highest = i;
    if (sign != 1 && q[i] - q[lowest] > least) {
      turns.push_back(lowest);
      sign = 1;
      highest = i;
    } else if (sign != -1 && q[highest] - q[i] > least) {
      turns.push_back(highest);
      sign = -1;
      lowest = i;
    }
  }
  if (sign != 0) turns.push_back(sign == 1 ? highest : lowest);
  return turns;
}

}  // namespace

std::vector<FieldSegment> segments_of_swarm(const std::vector<double>& t_s, const std::vector<Vec2>& centroid,
                                            double least_px) {
  std::vector<double> t;
  std::vector<Vec2> p;
  for (std::size_t i = 0; i < t_s.size(); ++i)
    if (std::isfinite(centroid[i].x)) {
      t.push_back(t_s[i]);
      p.push_back(centroid[i]);
    }
  if (p.size() < 5) return {};
  const double axis = main_axis(p);
  const Vec2 along{std::cos(axis), std::sin(axis)};
  std::vector<double> raw, q;
  for (const Vec2 v : p) raw.push_back(dot(v, along));
  for (std::size_t i = 0; i < raw.size(); ++i) {  // median of three, against outliers
    double a = raw[i > 0 ? i - 1 : i], b = raw[i], c = raw[std::min(i + 1, raw.size() - 1)];
    q.push_back(std::max(std::min(a, b), std::min(std::max(a, b), c)));
  }
  const auto [lo, hi] = std::minmax_element(q.begin(), q.end());
  const double range = *hi - *lo;
  if (!(range >= least_px)) return {};
  const std::vector<std::size_t> turns = turning_points(q, kReversal * range);
  std::vector<FieldSegment> segments;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
    const double from = q[turns[k]], path = q[turns[k + 1]] - from;
    if (std::fabs(path) < kReversal * range) continue;
    // From the end backwards, so that fluctuations at the start are ignored.
    const auto last_below = [&](double fraction) {
      std::size_t i = turns[k + 1];
      while (i > turns[k] && (q[i] - from) / path > fraction) --i;
      const double a = (q[i] - from) / path, b = i + 1 < q.size() ? (q[i + 1] - from) / path : a;
      return t[i] + (b > a ? (fraction - a) / (b - a) * (t[i + 1] - t[i]) : 0);
    };
    const double low = last_below(kOnsetLow), high = last_below(kOnsetHigh);
    const double start = low - (high - low) * kOnsetLow / (kOnsetHigh - kOnsetLow);
    const double deg = axis * 180 / std::numbers::pi + (path > 0 ? 0 : 180);
    segments.push_back({std::max(start, t[turns[k]]), 0, std::fmod(deg + 360, 360)});
  }
  for (std::size_t k = 0; k < segments.size(); ++k)
    segments[k].t1_s = k + 1 < segments.size() ? segments[k + 1].t0_s : t.back();
  return segments;
}

std::vector<FieldSegment> segments_of_field(const Series& record, bool against) {
  const auto t = record.find("t_s"), bx = record.find("field_x_ut"), by = record.find("field_y_ut");
  if (t.empty() || bx.empty() || by.empty()) return {};
  double strongest = 0;
  for (std::size_t k = 0; k < t.size(); ++k) strongest = std::max(strongest, std::hypot(bx[k], by[k]));
  std::vector<FieldSegment> segments;
  Vec2 sum;
  std::size_t from = 0;
  // A row holds the field before the command of that row takes effect, so the field changed directly after
  // the row before the first row with the new value.
  const auto close = [&](std::size_t at) {
    const double start = t[from > 0 ? from - 1 : 0], end = t[at - 1];
    if (end - start >= kMinDuration) {
      const Vec2 direction = against ? -1 * sum : sum;
      const double deg =
          std::atan2(-direction.y, direction.x) * 180 / std::numbers::pi;  // y is down in pictures
      segments.push_back({start, end, std::fmod(deg + 360, 360), norm(sum) / double(at - from) * 1e-6});
    }
    sum = {};
    from = at;
  };
  for (std::size_t k = 0; k < t.size(); ++k) {
    const Vec2 b{bx[k], by[k]};
    const bool on = norm(b) > kFieldOn * strongest;
    if (norm(sum) > 0 && (!on || dot(b, sum) < kSameDirection * norm(b) * norm(sum))) close(k);
    if (!on) continue;
    if (norm(sum) == 0) from = k;
    sum = sum + b;
  }
  if (norm(sum) > 0) close(t.size());
  if (segments.size() > 1 && segments.front().t0_s < t.front() + kMinDuration)
    segments.erase(segments.begin());
  return segments;
}

std::vector<FieldSegment> segments_of_motion(const std::filesystem::path& video, const VideoPart& part,
                                             int side, unsigned threads, const std::function<void()>& tick) {
  ActivityJob job;
  job.videos.push_back({.file = video, .from_s = part.from_s, .to_s = part.to_s});
  job.method = flow_part({}, published_flow());
  job.fps = part.fps;
  job.shrink = side;
  job.threads = threads;
  job.cells = false;
  job.responses = false;
  job.progress = [&](auto, auto, auto) { tick(); };
  std::vector<FieldSegment> segments;
  const ActivityResult activity = measure_activity(job);
  for (const MotionSegment& s : activity.videos.front().segments)
    segments.push_back({s.t0_s, s.t1_s, s.direction_deg});
  return segments;
}

}  // namespace faba
