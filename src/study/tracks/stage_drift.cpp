#include "study/tracks/stage_drift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/statistics.h"

namespace faba {
namespace {

constexpr std::size_t kMostDriftPoints = 2000000;
constexpr std::size_t kLeastPoints = 16;     // of a track: random walks and white errors then differ clearly
constexpr std::size_t kMostCompared = 1000;  // tracks
constexpr std::size_t kFewReferences = 5;    // assumed
constexpr double kFewMoving = 0.1;    // of the points, of a set that moves: fewer agree at random (assumed)
constexpr double kAgree = 9.21;       // chi-square with two degrees of freedom, 99 %
constexpr double kLeastError = 0.02;  // px, of the position of a well resolved spot (assumed)
constexpr double kSteadyTrack = 3;    // times the error of the steadiest tracks
constexpr double kSteadiest = 0.05;   // quantile of the errors
// Von Neumann's ratio (1941) of the squared successive differences to the squared residuals is 2 for white
// errors and 6 / n for a random walk of n steps, 0.4 for 16; a coded video correlates the errors.
constexpr double kWhiteErrors = 0.6;
// px: the pixel grid biases positions in the rhythm in which objects cross pixels, which is not white
// (assumed).
constexpr double kGridError = 0.15;
constexpr double kNearlyAll = 0.9;       // of the points: all objects keep their distances
constexpr double kClearDrift = 3;        // standard errors
constexpr double kSeenMotion = 1;        // px over the video: less does not matter
constexpr double kSeenJitter = 0.1;      // px (assumed)
constexpr double kMedianError = 1.2533;  // of the standard error of a median over that of a mean, normal

// A track as a straight line.
struct StraightTrack {
  const Track* track = nullptr;
  Vec2 velocity;         // px/s
  double error = 0;      // px: standard deviation of the residuals per axis
  double velocity2 = 0;  // variance of the velocity per axis
};

StraightTrack straight_track(const Track& t) {
  const auto n = double(t.points.size());
  double ts = 0, xs = 0, ys = 0;
  for (const TrackPoint& p : t.points) {
    ts += p.t_s / n;
    xs += p.x_px / n;
    ys += p.y_px / n;
  }
  double tt = 0, tx = 0, ty = 0;
  for (const TrackPoint& p : t.points) {
    tt += (p.t_s - ts) * (p.t_s - ts);
    tx += (p.t_s - ts) * (p.x_px - xs);
    ty += (p.t_s - ts) * (p.y_px - ys);
  }
  StraightTrack line{&t, {tx / tt, ty / tt}};
  double squares = 0;
  for (const TrackPoint& p : t.points) {
    const Vec2 off{p.x_px - xs - line.velocity.x * (p.t_s - ts),
                   p.y_px - ys - line.velocity.y * (p.t_s - ts)};
    squares += dot(off, off);
  }
  line.error = std::max(kLeastError, std::sqrt(squares / (2 * (n - 2))));
  line.velocity2 = line.error * line.error / tt;
  return line;
}

// The longest tracks whose positions scatter least about a line.
std::vector<StraightTrack> steady_lines(const std::vector<Track>& tracks) {
  std::vector<StraightTrack> lines;
  std::vector<double> errors;
  for (const Track& t : tracks) {
    if (t.points.size() < kLeastPoints) continue;
    lines.push_back(straight_track(t));
    errors.push_back(lines.back().error);
  }
  if (lines.empty()) return lines;
  const double most = kSteadyTrack * quantile(errors, kSteadiest);
  std::erase_if(lines, [&](const StraightTrack& l) { return l.error > most; });
  std::stable_sort(lines.begin(), lines.end(), [](const StraightTrack& a, const StraightTrack& b) {
    return a.track->points.size() > b.track->points.size();
  });
  if (lines.size() > kMostCompared) lines.resize(kMostCompared);
  return lines;
}

std::vector<StraightTrack> with_velocity(const std::vector<StraightTrack>& lines, Vec2 velocity,
                                         double velocity2) {
  std::vector<StraightTrack> out;
  for (const StraightTrack& l : lines) {
    const Vec2 off = l.velocity - velocity;
    if (dot(off, off) <= kAgree * (l.velocity2 + velocity2)) out.push_back(l);
  }
  return out;
}

double points_of(const std::vector<StraightTrack>& lines) {
  double n = 0;
  for (const StraightTrack& l : lines) n += double(l.track->points.size());
  return n;
}

// Whether the mean velocity of the lines, each compatible with rest, is zero as well.
bool are_at_rest(const std::vector<StraightTrack>& lines) {
  Vec2 sum;
  double weight = 0;
  for (const StraightTrack& l : lines) {
    sum = sum + (1 / l.velocity2) * l.velocity;
    weight += 1 / l.velocity2;
  }
  return dot(sum, sum) <= kAgree * weight;
}

// The lines that agree on a velocity: the stationary ones if there are enough, else the largest set.
std::vector<StraightTrack> largest_set(const std::vector<StraightTrack>& lines) {
  std::vector<StraightTrack> best = with_velocity(lines, {}, 0);
  if (best.size() >= kFewReferences && are_at_rest(best)) return best;
  for (const StraightTrack& l : lines)
    if (std::vector<StraightTrack> set = with_velocity(lines, l.velocity, l.velocity2);
        points_of(set) > points_of(best))
      best = std::move(set);
  return best;
}

// Cumulative median displacement of the lines from frame to frame.
struct CommonPath {
  std::uint64_t first = 0;
  std::vector<Vec2> at;
  std::vector<double> members;  // of each step
};

CommonPath common_path(const std::vector<StraightTrack>& lines, const std::vector<Track>& tracks,
                       Vec2 velocity, double frame_s) {
  CommonPath path;
  path.first = ~std::uint64_t{0};
  std::uint64_t last = 0;
  for (const Track& t : tracks) {
    path.first = std::min(path.first, t.points.front().frame);
    last = std::max(last, t.points.back().frame);
  }
  const auto steps = std::size_t(last - path.first);
  std::vector<std::vector<double>> dx(steps), dy(steps);
  for (const StraightTrack& l : lines)
    for (std::size_t i = 0; i + 1 < l.track->points.size(); ++i) {
      const TrackPoint &p = l.track->points[i], &q = l.track->points[i + 1];
      if (q.frame != p.frame + 1) continue;
      dx[std::size_t(p.frame - path.first)].push_back(q.x_px - p.x_px);
      dy[std::size_t(p.frame - path.first)].push_back(q.y_px - p.y_px);
    }
  path.at.resize(steps + 1);
  for (std::size_t i = 0; i < steps; ++i) {
    const Vec2 step = dx[i].empty() ? frame_s * velocity : Vec2{median(dx[i]), median(dy[i])};
    path.at[i + 1] = path.at[i] + step;
    path.members.push_back(double(dx[i].size()));
  }
  return path;
}

// Residuals of a track relative to the path.
struct PathResidual {
  double error = 0;    // px per axis
  double neumann = 0;  // von Neumann's ratio
};
PathResidual residual_of(const Track& t, const CommonPath& path) {
  std::vector<Vec2> off;
  Vec2 mean;
  for (const TrackPoint& p : t.points) {
    off.push_back(Vec2{p.x_px, p.y_px} - path.at[std::size_t(p.frame - path.first)]);
    mean = mean + (1 / double(t.points.size())) * off.back();
  }
  double squares = 0, steps = 0;
  for (std::size_t i = 0; i < off.size(); ++i) {
    squares += dot(off[i] - mean, off[i] - mean);
    if (i > 0) steps += dot(off[i] - off[i - 1], off[i] - off[i - 1]);
  }
  const auto n = double(off.size());
  return {std::max(kLeastError, std::sqrt(squares / (2 * (n - 1)))),
          squares > 0 ? steps / squares * n / (n - 1) : 2};
}

// The lines that keep their distances, and the typical error of their positions.
struct Rigid {
  std::vector<StraightTrack> lines;
  double error = 0;
};
Rigid rigid_lines(const std::vector<StraightTrack>& set, const CommonPath& path) {
  Rigid rigid;
  std::vector<double> errors;
  errors.reserve(set.size());
  for (const StraightTrack& l : set) errors.push_back(residual_of(*l.track, path).error);
  rigid.error = median(errors);
  for (const StraightTrack& l : set)
    if (const PathResidual r = residual_of(*l.track, path);
        r.error <= kSteadyTrack * rigid.error && (r.neumann > kWhiteErrors || r.error < kGridError))
      rigid.lines.push_back(l);
  return rigid;
}

void set_velocity(StageDrift& d, const std::vector<StraightTrack>& lines) {
  std::vector<double> vx, vy;
  double formal = 0;
  for (const StraightTrack& l : lines) {
    vx.push_back(l.velocity.x);
    vy.push_back(l.velocity.y);
    formal += l.velocity2 / double(lines.size());
  }
  const RobustSpread<double> x = robust_spread(vx), y = robust_spread(vy);
  d.drift_px_s = {x.median, y.median};
  const double spread2 = std::max(formal, 0.5 * (x.sd * x.sd + y.sd * y.sd));
  d.drift_se_px_s = kMedianError * std::sqrt(spread2 / double(lines.size()));
}

double jitter_of(const CommonPath& path, Vec2 velocity, double frame_s, double error) {
  double squares = 0, expected = 0, n = 0;
  for (std::size_t i = 0; i + 1 < path.at.size(); ++i) {
    if (path.members[i] < double(kFewReferences)) continue;
    const Vec2 off = path.at[i + 1] - path.at[i] - frame_s * velocity;
    squares += 0.5 * dot(off, off);
    // The difference of two positions, as the median over the members.
    expected += 2 * error * error * kMedianError * kMedianError / path.members[i];
    n += 1;
  }
  return n > 0 ? std::sqrt(std::max(0.0, (squares - expected) / n) / 2) : 0;
}

}  // namespace

const char* word_of(StageFinding finding) {
  switch (finding) {
    case StageFinding::at_rest:
      return "at_rest";
    case StageFinding::drifting:
      return "drifting";
    case StageFinding::all_rigid:
      return "all_rigid";
    case StageFinding::undecided:
      break;
  }
  return "undecided";
}

Track StageDrift::relative(const Track& track) const {
  Track out = track;
  if (path_px.empty()) return out;
  for (TrackPoint& p : out.points) {
    const Vec2 at = path_px[std::min(path_px.size() - 1, std::size_t(p.frame - first_frame))];
    p.x_px -= at.x;
    p.y_px -= at.y;
  }
  return out;
}

void DriftSurvey::take(Track track) {
  points_ += track.points.size();
  if (points_ > kMostDriftPoints) {
    tracks_ = {};
    return;
  }
  track.points.shrink_to_fit();
  tracks_.push_back(std::move(track));
}

StageDrift DriftSurvey::result() const {
  StageDrift d;
  const std::vector<StraightTrack> lines = steady_lines(tracks_);
  const std::vector<StraightTrack> set = largest_set(lines);
  if (set.size() < kFewReferences) return d;
  set_velocity(d, set);
  CommonPath path = common_path(set, tracks_, d.drift_px_s, frame_s_);
  const Rigid rigid = rigid_lines(set, path);
  if (rigid.lines.size() < kFewReferences) return {};
  set_velocity(d, rigid.lines);
  path = common_path(rigid.lines, tracks_, d.drift_px_s, frame_s_);
  d.references = rigid.lines.size();
  d.error_px = rigid.error;
  d.jitter_px = jitter_of(path, d.drift_px_s, frame_s_, rigid.error);
  d.first_frame = path.first;
  double all = 0;
  for (const Track& t : tracks_)
    if (t.points.size() >= kLeastPoints) all += double(t.points.size());
  const double speed = norm(d.drift_px_s);
  const bool drifts =
      speed > kClearDrift * d.drift_se_px_s && speed * frame_s_ * double(path.at.size()) > kSeenMotion;
  const bool moves = drifts || d.jitter_px > kSeenJitter;
  if (drifts && points_of(rigid.lines) < kFewMoving * all) return {};
  d.finding = !moves                                      ? StageFinding::at_rest
              : points_of(rigid.lines) > kNearlyAll * all ? StageFinding::all_rigid
                                                          : StageFinding::drifting;
  d.path_px = std::move(path.at);
  return d;
}

}  // namespace faba
