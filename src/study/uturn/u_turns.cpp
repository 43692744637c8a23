#include "study/uturn/u_turns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics.h"
#include "core/vec.h"

namespace faba {
namespace {

constexpr double kMovingSpeed = 9;   // v^2 over the variance by localisation: three standard deviations
constexpr double kAcross = 0.5;      // |c|: within 60 degrees of the field before and after a turn
constexpr double kTurnWindow = 2.5;  // evaluated time over half_s: slow and late cells complete their turns
constexpr double kFramesAfterHalf = 4;  // of a window after half_s
constexpr double kLargestGap = 3;       // frames between two detections
constexpr std::size_t kFewCells = 5;

/// Velocity between two detections of a cell.
struct Velocity {
  double t_s, dt_s;  ///< mid-time and duration
  Vec2 u;            ///< px/s; after rotation: x along the field
};
struct CellPath {
  std::uint64_t track;
  std::vector<Velocity> v;
};

std::vector<CellPath> paths_of(const std::vector<Track>& tracks, double frame_s) {
  std::vector<CellPath> paths;
  for (const Track& t : tracks) {
    CellPath path{t.number, {}};
    for (std::size_t i = 1; i < t.points.size(); ++i) {
      const TrackPoint &a = t.points[i - 1], &b = t.points[i];
      const double dt = b.t_s - a.t_s;
      if (dt > (kLargestGap + 0.5) * frame_s) {
        if (path.v.size() > 1) paths.push_back(path);
        path.v.clear();
        continue;
      }
      path.v.push_back({(a.t_s + b.t_s) / 2, dt, {(b.x_px - a.x_px) / dt, (b.y_px - a.y_px) / dt}});
    }
    if (path.v.size() > 1) paths.push_back(std::move(path));
  }
  return paths;
}

// Rotates all velocities so that most of the motion is along x.
void align(std::vector<CellPath>& paths) {
  double cos2 = 0, sin2 = 0;
  for (const CellPath& p : paths)
    for (const Velocity& v : p.v) {
      cos2 += v.u.x * v.u.x - v.u.y * v.u.y;
      sin2 += 2 * v.u.x * v.u.y;
    }
  const double axis = std::atan2(sin2, cos2) / 2, c = std::cos(axis), s = std::sin(axis);
  for (CellPath& p : paths)
    for (Velocity& v : p.v) v.u = {c * v.u.x + s * v.u.y, c * v.u.y - s * v.u.x};
}

// Variance of a velocity component by localisation: differences of velocities along a straight path have
// three times of it, because they share a position.
double localisation_variance(const std::vector<CellPath>& paths) {
  std::vector<double> change;
  for (const CellPath& p : paths)
    for (std::size_t i = 1; i < p.v.size(); ++i) {
      const Vec2 a = p.v[i - 1].u, b = p.v[i].u;
      if (std::fabs(a.x) > 0.9 * norm(a) && std::fabs(b.x) > 0.9 * norm(b))
        change.push_back(std::fabs(b.x - a.x));
    }
  if (change.empty()) return 0;
  const double sd = kMadToSd * median(change);
  return sd * sd / 3;
}

// The part of a path around one reversal.
struct Reversal {
  double at_s, from_s, to_s;  ///< the reversal, and the ones before and after it
};

struct Segment {
  std::uint64_t track;
  double speed;  ///< px/s
  std::vector<Velocity>
      v;  ///< x: c times the speed, negative before the turn; times relative to the reversal
};

// The moving cells that are seen before and after the reversal.
std::vector<Segment> segments_at(const std::vector<CellPath>& paths, const Reversal& r, double frame_s,
                                 double noise) {
  std::vector<Segment> out;
  for (const CellPath& p : paths) {
    Segment s{p.track, 0, {}};
    double before = 0, square = 0;
    for (const Velocity& v : p.v) {
      if (v.t_s < r.from_s || v.t_s >= r.to_s) continue;
      s.v.push_back(v);
      s.v.back().t_s -= r.at_s;
      square += dot(v.u, v.u) - 2 * noise;
      if (v.t_s < r.at_s && v.t_s > r.at_s - 5 * frame_s) before += v.u.x;
    }
    if (before == 0 || s.v.back().t_s < 0) continue;
    square /= double(s.v.size());
    if (!(square > kMovingSpeed * noise) || !(square > 0)) continue;
    s.speed = std::sqrt(square);
    if (before > 0)
      for (Velocity& v : s.v) v.u.x = -v.u.x;
    out.push_back(std::move(s));
  }
  return out;
}

// Time at which the median cell moves across the field; NaN if it never does.
double half_time(const std::vector<Segment>& segments, double frame_s, double end_s) {
  const auto bins = std::size_t(std::max(0.0, end_s / frame_s));
  std::vector<std::vector<double>> c(bins);
  for (const Segment& s : segments)
    for (const Velocity& v : s.v) {
      const double bin = v.t_s / frame_s;
      if (bin >= 0 && bin < double(bins)) c[std::size_t(bin)].push_back(v.u.x / s.speed);
    }
  for (std::size_t i = 0; i < bins; ++i)
    if (c[i].size() >= kFewCells && median(c[i]) > 0) return (double(i) + 0.5) * frame_s;
  return kNaN;
}

// Sums over the velocities of aligned cells.
struct Aligned {
  double sin2 = 0, cos = 0;
  void add(const Segment& s, const Velocity& v, double noise, double sign) {
    sin2 += (v.u.y * v.u.y - noise) / (s.speed * s.speed);
    cos += sign * v.u.x / s.speed;
  }
};

// The window of one cell from the last velocity before the reversal to the end of the window.
struct Window {
  std::size_t first = 0, last = 0;
};
std::optional<Window> window_of(const Segment& s, double window_s, double frame_s) {
  Window w;
  bool before = false;
  for (std::size_t i = 0; i < s.v.size(); ++i) {
    if (s.v[i].t_s < 0) {
      w.first = i;
      before = true;
    }
    if (s.v[i].t_s <= window_s) w.last = i;
  }
  const bool complete = before && s.v[w.first].t_s > -(kLargestGap + 1) * frame_s &&
                        s.v[w.last].t_s > window_s - (kLargestGap + 1) * frame_s && w.last > w.first + 1;
  return complete ? std::optional(w) : std::nullopt;
}

struct Evaluated {
  std::optional<UTurn> turn;
  bool turned = false;  ///< the direction along the field has changed
  double across = 0,
         along = 0;  ///< sums of squared speeds across and along the field, over the speed squared
  double across_n = 0, along_n = 0;
};

Evaluated evaluated(const Segment& s, const Window& w, double disorder, double noise) {
  Evaluated e;
  const double square = s.speed * s.speed;
  const double first = s.v[w.first].u.x / s.speed, last = s.v[w.last].u.x / s.speed;
  double integral = 0, most_across = 0;
  for (std::size_t i = w.first; i <= w.last; ++i) {
    const Velocity& v = s.v[i];
    const double c = v.u.x / s.speed, sin2 = (v.u.y * v.u.y - noise) / square;
    // Both ends are mid-times of a velocity.
    const double dt = i == w.first  ? (s.v[i + 1].t_s - v.t_s) / 2
                      : i == w.last ? (v.t_s - s.v[i - 1].t_s) / 2
                                    : (s.v[i + 1].t_s - s.v[i - 1].t_s) / 2;
    integral += (sin2 - disorder * c) * dt;
    most_across = std::max(most_across, sin2);
    const double speed2 = (dot(v.u, v.u) - 2 * noise) / square;
    if (std::fabs(c) < kAcross) {
      e.across += speed2;
      ++e.across_n;
    } else {
      e.along += speed2;
      ++e.along_n;
    }
  }
  e.turned = first < -kAcross && last > kAcross;
  // A cell that reverses its swimming direction changes c without moving across the field.
  if (e.turned && most_across > kAcross) e.turn = UTurn{s.track, integral / (last - first)};
  return e;
}

}  // namespace

UTurnSurvey find_u_turns(const std::vector<Track>& tracks, const std::vector<double>& reversals_s,
                         double frame_s) {
  std::vector<CellPath> paths = paths_of(tracks, frame_s);
  align(paths);
  const double noise = localisation_variance(paths);
  double end = 0;
  for (const CellPath& p : paths) end = std::max(end, p.v.back().t_s);
  UTurnSurvey survey;
  survey.frame_s = frame_s;
  std::vector<std::vector<Segment>> all;
  std::vector<double> halves, ends;
  for (std::size_t k = 0; k < reversals_s.size(); ++k) {
    const Reversal r{reversals_s[k], k > 0 ? reversals_s[k - 1] : -std::numeric_limits<double>::infinity(),
                     k + 1 < reversals_s.size() ? reversals_s[k + 1] : end + frame_s};
    all.push_back(segments_at(paths, r, frame_s, noise));
    ends.push_back(r.to_s - r.at_s);
    const double half = half_time(all.back(), frame_s, ends.back());
    if (std::isnan(half)) {
      survey.unseen_s.push_back(r.at_s);
      all.pop_back();
      ends.pop_back();
    } else {
      halves.push_back(half);
    }
  }
  if (halves.empty()) return survey;
  survey.half_s = median(halves);
  const double wanted = std::max(kTurnWindow * survey.half_s, survey.half_s + kFramesAfterHalf * frame_s);
  survey.window_s = std::min(wanted, order_statistic(ends, 0) - frame_s);

  Aligned after, before;
  double noise_ratio = 0, n = 0;
  for (const auto& segments : all)
    for (const Segment& s : segments) {
      noise_ratio += noise / (s.speed * s.speed);
      ++n;
      for (const Velocity& v : s.v) {
        if (v.t_s > survey.window_s) after.add(s, v, noise, 1);
        if (v.t_s < 0 && v.t_s > -survey.window_s / 2) before.add(s, v, noise, -1);
      }
    }
  survey.noise = n > 0 ? noise_ratio / n : 0;
  const Aligned& aligned = after.cos > before.cos ? after : before;
  survey.disorder = aligned.cos > 0 ? std::max(0.0, aligned.sin2 / aligned.cos) : 1;

  Evaluated sum;
  for (const auto& segments : all)
    for (const Segment& s : segments) {
      const auto window = window_of(s, survey.window_s, frame_s);
      if (!window) continue;
      ++survey.cells;
      const Evaluated e = evaluated(s, *window, survey.disorder, noise);
      if (!e.turned) continue;
      if (e.turn) survey.turns.push_back(*e.turn);
      sum.across += e.across;
      sum.across_n += e.across_n;
      sum.along += e.along;
      sum.along_n += e.along_n;
    }
  if (sum.across_n > 0 && sum.along > 0)
    survey.turn_speed = std::sqrt(std::max(0.0, sum.across / sum.across_n / (sum.along / sum.along_n)));
  return survey;
}

}  // namespace faba
