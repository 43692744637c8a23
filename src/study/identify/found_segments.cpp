#include "study/identify/found_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/data/flow_choice.h"
#include "study/motion/activity.h"

namespace faba {
namespace {

constexpr double kTurn = 0.25;  // share of the whole way that a swarm must go back before it counts
constexpr double kLeaves = 0.05, kGone = 0.25;  // shares of a segment's way that its beginning is told from

constexpr double kLeastHeld = 0.4;       // s: of a field that is held
constexpr double kFieldOn = 0.2;         // of the strongest
constexpr double kSameDirection = 0.87;  // cosine of 30 degrees

/// Angle of the line that the points are spread along most.
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

/// Where q turns: the ends of its legs, each longer than `least`. Empty when there is no such leg.
std::vector<std::size_t> turning_points(const std::vector<double>& q, double least) {
  std::vector<std::size_t> turns;
  std::size_t lowest = 0, highest = 0;  // of the leg that is on
  int way = 0;
  for (std::size_t i = 1; i < q.size(); ++i) {
    if (q[i] < q[lowest]) lowest = i;
    if (q[i] > q[highest]) highest = i;
    if (way != 1 && q[i] - q[lowest] > least) {
      turns.push_back(lowest);
      way = 1;
      highest = i;
    } else if (way != -1 && q[highest] - q[i] > least) {
      turns.push_back(highest);
      way = -1;
      lowest = i;
    }
  }
  if (way != 0) turns.push_back(way == 1 ? highest : lowest);
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
  for (std::size_t i = 0; i < raw.size(); ++i) {  // the middle of three: a single bad frame is no turn
    double a = raw[i > 0 ? i - 1 : i], b = raw[i], c = raw[std::min(i + 1, raw.size() - 1)];
    q.push_back(std::max(std::min(a, b), std::min(std::max(a, b), c)));
  }
  const auto [lo, hi] = std::minmax_element(q.begin(), q.end());
  const double range = *hi - *lo;
  if (!(range >= least_px)) return {};
  const std::vector<std::size_t> turns = turning_points(q, kTurn * range);
  std::vector<FieldSegment> segments;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
    const double from = q[turns[k]], way = q[turns[k + 1]] - from;
    if (std::fabs(way) < kTurn * range) continue;
    // Backwards, so that what wavers at the beginning does not count.
    const auto last_below = [&](double share) {
      std::size_t i = turns[k + 1];
      while (i > turns[k] && (q[i] - from) / way > share) --i;
      const double a = (q[i] - from) / way, b = i + 1 < q.size() ? (q[i + 1] - from) / way : a;
      return t[i] + (b > a ? (share - a) / (b - a) * (t[i + 1] - t[i]) : 0);
    };
    const double leaves = last_below(kLeaves), gone = last_below(kGone);
    const double begins = leaves - (gone - leaves) * kLeaves / (kGone - kLeaves);
    const double deg = axis * 180 / std::numbers::pi + (way > 0 ? 0 : 180);
    segments.push_back({std::max(begins, t[turns[k]]), 0, std::fmod(deg + 360, 360)});
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
  // A row has the field at its moment, before the command that is given then: it turned right after the row
  // before the first that shows it.
  const auto close = [&](std::size_t at) {
    const double begins = t[from > 0 ? from - 1 : 0], ends = t[at - 1];
    if (ends - begins >= kLeastHeld) {
      const Vec2 way = against ? -1 * sum : sum;
      const double deg = std::atan2(-way.y, way.x) * 180 / std::numbers::pi;  // y is down in pictures
      segments.push_back({begins, ends, std::fmod(deg + 360, 360), norm(sum) / double(at - from) * 1e-6});
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
  if (segments.size() > 1 && segments.front().t0_s < t.front() + kLeastHeld) segments.erase(segments.begin());
  return segments;
}

std::vector<FieldSegment> segments_of_motion(const std::filesystem::path& video, double fps, int side,
                                             const std::function<void()>& tick) {
  ActivityJob job;
  job.videos.push_back({.file = video});
  job.method = flow_part({}, published_flow());
  job.fps = fps;
  job.shrink = side;
  job.cells = false;
  job.progress = [&](auto, auto, auto) { tick(); };
  std::vector<FieldSegment> segments;
  const ActivityResult activity = measure_activity(job);
  for (const MotionSegment& s : activity.videos.front().segments)
    segments.push_back({s.t0_s, s.t1_s, s.direction_deg});
  return segments;
}

}  // namespace faba
