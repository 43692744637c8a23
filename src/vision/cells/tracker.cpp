#include "vision/cells/tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/statistics.h"
#include "vision/cells/assignment.h"

namespace faba {
namespace {

constexpr std::size_t kLookAhead = 12;      // frames, buffered to estimate reach and motion model
constexpr double kGate = 4;                 // standard deviations of a prediction
constexpr double kMinPositionError = 0.15;  // px, minimum position error of a spot
constexpr double kForgetting = 0.98;        // forgetting factor per frame of the prediction errors
constexpr double kSwitchRatio = 0.8;        // ratio of squared errors at which the motion model is changed
constexpr double kMinLinks = 20;
constexpr double kUnknownReach = 10;  // px, assumed if no two consecutive frames have spots

double position_variance(const Spot& s) { return kMinPositionError * kMinPositionError + s.sd_px * s.sd_px; }

// Calls visit(i) for all spots (sorted by y) within `reach` of `at` along both axes.
template <class Visit>
void each_near(const std::vector<Spot>& spots, Vec2 at, double reach, const Visit& visit) {
  auto s = std::lower_bound(spots.begin(), spots.end(), at.y - reach,
                            [](const Spot& a, double y) { return a.y_px < y; });
  for (; s != spots.end() && s->y_px <= at.y + reach; ++s)
    if (std::fabs(s->x_px - at.x) <= reach) visit(std::size_t(s - spots.begin()));
}

// Memory grows by a quarter instead of twice: in a long video most of it is that of live tracks.
void append(std::vector<TrackPoint>& points, const TrackPoint& point) {
  if (points.size() == points.capacity()) points.reserve(points.size() + points.size() / 4 + 4);
  points.push_back(point);
}

}  // namespace

Tracker::Tracker(TrackerOptions options) : options_(options) {
  if (options_.max_gap_frames < 0 || options_.min_points < 1 || options_.max_points < 2)
    throw Error(Errc::internal, "tracker",
                "max_gap_frames must be >= 0, min_points >= 1 and max_points >= 2");
}

void Tracker::take(std::uint64_t frame, double t_s, const std::vector<Spot>& given) {
  if ((started_ || !buffered_.empty()) && !(t_s > last_t_))
    throw Error(Errc::internal, "tracker", "the time of a frame must be after that of the previous frame");
  last_t_ = t_s;
  std::vector<Spot> spots = given;
  std::stable_sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.y_px < b.y_px; });
  if (started_) return step(frame, t_s, spots);
  buffered_.push_back({frame, t_s, std::move(spots)});
  if (buffered_.size() == kLookAhead) start();
}

// The first frames are processed twice: once to estimate the motion parameters, once to track.
void Tracker::start() {
  started_ = true;
  const std::vector<BufferedFrame> first = std::exchange(buffered_, {});
  std::vector<double> gaps;
  for (std::size_t i = 1; i < first.size(); ++i) gaps.push_back(first[i].t_s - first[i - 1].t_s);
  frame_s_ = gaps.empty() ? 1 : median_high(gaps);
  if (!(options_.search_radius_px > 0)) {
    std::vector<std::vector<Spot>> frames;
    frames.reserve(first.size());
    for (const BufferedFrame& w : first) frames.push_back(w.spots);
    options_.search_radius_px = estimated_search_radius(frames, &crowded_);
  }
  const double reach = options_.search_radius_px;
  scatter_ = reach * reach / 8;
  acceleration_ = reach * reach / 4 / (frame_s_ * frame_s_ * frame_s_);
  motion_ = options_.motion == Motion::velocity ? Motion::velocity : Motion::nearest;
  for (const BufferedFrame& w : first) step(w.frame, w.t_s, w.spots);
  live_.clear();
  finished_.clear();
  confirmed_ = dropped_ = 0;
  for (const BufferedFrame& w : first) step(w.frame, w.t_s, w.spots);
}

void Tracker::finish() {
  if (!started_ && !buffered_.empty()) start();
  started_ = true;
  for (Live& l : live_) end_track(l);
  live_.clear();
}

std::vector<Track> Tracker::finished() { return std::exchange(finished_, {}); }

std::vector<const Track*> Tracker::live() const {
  std::vector<const Track*> out;
  for (const Live& l : live_)
    if (l.track.number > 0) out.push_back(&l.track);
  return out;
}

Tracker::Prediction Tracker::predict(const Live& l, double t_s) const {
  const double dt = t_s - l.t_s, frames = dt / frame_s_,
               reach = options_.search_radius_px * std::max(1.0, frames);
  const double max_variance = reach * reach / (kGate * kGate);
  if (motion_ == Motion::nearest)
    return {l.at, std::min(max_variance, std::max(scatter_ * frames, 1e-3)), reach};
  if (l.points < 2) return {l.at + dt * common_velocity_, max_variance, reach};
  const double var = l.var_at + dt * (2 * l.cov + dt * l.var_velocity) + acceleration_ * dt * dt * dt / 3 +
                     kMinPositionError * kMinPositionError;
  return {l.at + dt * l.velocity, std::min(var, max_variance), std::min(reach, kGate * std::sqrt(var) + 0.5)};
}

// Second pass: unassigned tracks may take any spot within reach of their last position.
void Tracker::assign(double t_s, const std::vector<Spot>& spots, bool second, std::vector<int>& of_track,
                     std::vector<bool>& taken) const {
  std::vector<PossiblePair> candidates;
  const double widest = options_.search_radius_px * options_.search_radius_px / (kGate * kGate);
  for (std::size_t i = 0; i < live_.size(); ++i) {
    if (of_track[i] >= 0) continue;
    Prediction f = predict(live_[i], t_s);
    if (second) {
      f.gate = options_.search_radius_px * std::max(1.0, (t_s - live_[i].t_s) / frame_s_);
      f.at = live_[i].at;
      f.var = f.gate * f.gate / (kGate * kGate);
    }
    each_near(spots, f.at, f.gate, [&](std::size_t k) {
      const Vec2 d = Vec2{spots[k].x_px, spots[k].y_px} - f.at;
      if (taken[k] || dot(d, d) > f.gate * f.gate) return;
      const double gain = kGate * kGate + 2 * std::log(widest / f.var) - dot(d, d) / f.var;
      candidates.push_back({int(i), int(k), std::max(gain, 1e-3)});
    });
  }
  const std::vector<int> best = best_assignment(int(live_.size()), int(spots.size()), candidates);
  for (std::size_t i = 0; i < best.size(); ++i)
    if (best[i] >= 0) {
      of_track[i] = best[i];
      taken[std::size_t(best[i])] = true;
    }
}

void Tracker::step(std::uint64_t frame, double t_s, const std::vector<Spot>& spots) {
  std::vector<int> of_track(live_.size(), -1);
  std::vector<bool> taken(spots.size(), false);
  assign(t_s, spots, false, of_track, taken);
  if (motion_ == Motion::velocity) assign(t_s, spots, true, of_track, taken);
  error_nearest_ *= kForgetting;
  error_velocity_ *= kForgetting;
  link_weight_ *= kForgetting;
  std::vector<Live> kept;
  for (std::size_t i = 0; i < live_.size(); ++i) {
    Live& l = live_[i];
    if (of_track[i] >= 0) {
      update_track(l, frame, t_s, spots[std::size_t(of_track[i])]);
    } else if (++l.missed > options_.max_gap_frames) {
      end_track(l);
      continue;
    }
    kept.push_back(std::move(l));
  }
  live_ = std::move(kept);
  for (std::size_t k = 0; k < spots.size(); ++k)
    if (!taken[k]) start_track(frame, t_s, spots[k]);
  update_common_velocity();
  if (options_.motion == Motion::automatic && link_weight_ > kMinLinks) {
    const double now = motion_ == Motion::nearest ? error_nearest_ : error_velocity_;
    const double other = motion_ == Motion::nearest ? error_velocity_ : error_nearest_;
    if (other < kSwitchRatio * now) motion_ = motion_ == Motion::nearest ? Motion::velocity : Motion::nearest;
  }
}

void Tracker::compare_models(const Live& l, double dt, Vec2 observed) {
  const Vec2 without_motion = observed - l.at, with_velocity = observed - (l.at + dt * l.velocity);
  error_nearest_ += dot(without_motion, without_motion);
  error_velocity_ += dot(with_velocity, with_velocity);
  link_weight_ += 1;
}

void Tracker::update_track(Live& l, std::uint64_t frame, double t_s, const Spot& spot) {
  const double dt = t_s - l.t_s, frames = dt / frame_s_, r = position_variance(spot);
  const Vec2 observed{spot.x_px, spot.y_px};
  if (l.points > 2) compare_models(l, dt, observed);
  const Vec2 moved = observed - l.at;
  scatter_ += 0.002 * (0.5 * dot(moved, moved) / frames - scatter_);
  if (l.points < 2) {
    l.velocity = (1 / dt) * moved;
    l.at = observed;
    l.var_at = r;
    l.cov = r / dt;
    l.var_velocity = 2 * r / (dt * dt) + acceleration_ * dt / 3;
  } else {
    // Kalman filter of one axis; both axes have the same variances.
    const double q = acceleration_ * dt;
    const double paa = l.var_at + dt * (2 * l.cov + dt * l.var_velocity) + q * dt * dt / 3;
    const double pav = l.cov + dt * l.var_velocity + q * dt / 2, pvv = l.var_velocity + q;
    const Vec2 innovation = observed - (l.at + dt * l.velocity);
    const double s = paa + r, ka = paa / s, kv = pav / s;
    l.at = l.at + dt * l.velocity + ka * innovation;
    l.velocity = l.velocity + kv * innovation;
    l.var_at = (1 - ka) * paa;
    l.cov = (1 - ka) * pav;
    l.var_velocity = pvv - kv * pav;
    // The acceleration variance is adapted to the prediction errors: the expectation of |innovation|^2 is 2
    // s.
    const double off = std::min(dot(innovation, innovation) / (2 * s), kGate * kGate);
    acceleration_ *= 1 + 0.002 * (off - 1);
  }
  // Filtered positions lag behind. With the `nearest` model the last measured position is used instead.
  if (motion_ == Motion::nearest) l.at = observed;
  l.t_s = t_s;
  l.missed = 0;
  ++l.points;
  append(l.track.points, {frame, t_s, spot.x_px, spot.y_px, spot.mass, spot.snr});
  if (l.points == std::size_t(options_.min_points)) l.track.number = ++confirmed_;
  if (l.track.points.size() >= std::size_t(options_.max_points) && l.track.number > 0) {
    l.track.continues = true;
    finished_.push_back(l.track);
    l.track.continues = false;
    l.track.points.clear();
  }
}

void Tracker::start_track(std::uint64_t frame, double t_s, const Spot& spot) {
  Live l;
  l.at = {spot.x_px, spot.y_px};
  l.t_s = t_s;
  l.points = 1;
  append(l.track.points, {frame, t_s, spot.x_px, spot.y_px, spot.mass, spot.snr});
  if (options_.min_points == 1) l.track.number = ++confirmed_;
  live_.push_back(std::move(l));
}

void Tracker::end_track(Live& l) {
  if (l.track.number == 0)
    ++dropped_;
  else if (!l.track.points.empty())
    finished_.push_back(std::move(l.track));
}

void Tracker::update_common_velocity() {
  std::vector<double> x, y;
  for (const Live& l : live_)
    if (l.points >= 3) {
      x.push_back(l.velocity.x);
      y.push_back(l.velocity.y);
    }
  if (double(x.size()) < kMinLinks) return;
  common_velocity_ = {median_high(x), median_high(y)};
}

double estimated_search_radius(const std::vector<std::vector<Spot>>& frames, bool* cut) {
  constexpr int kNth = 6;  // rank of the neighbour that determines the local density
  constexpr double kFraction = 0.95, kMargin = 1.25, kMinReach = 2, kSpacings = 0.75;
  struct Pair {
    double nearest, density;
  };
  std::vector<Pair> pairs;
  std::vector<double> spacing;
  for (std::size_t f = 0; f + 1 < frames.size(); ++f)
    for (const Spot& a : frames[f]) {
      std::vector<double> d;
      for (const Spot& b : frames[f + 1]) d.push_back(std::hypot(a.x_px - b.x_px, a.y_px - b.y_px));
      if (d.empty()) continue;
      const std::size_t nth = std::min<std::size_t>(kNth, d.size()) - 1;
      std::nth_element(d.begin(), d.begin() + std::ptrdiff_t(nth), d.end());
      const double area = 3.14159265358979 * d[nth] * d[nth];
      // One of the neighbours is the spot itself in the next frame.
      const double density = nth >= 2 && area > 0 ? double(nth - 1) / area : 0;
      pairs.push_back({*std::min_element(d.begin(), d.begin() + std::ptrdiff_t(nth) + 1), density});
      if (density > 0) spacing.push_back(1 / std::sqrt(density));
    }
  if (pairs.empty()) return kUnknownReach;
  double far = spacing.empty() ? 0 : kSpacings * median_high(spacing);
  if (spacing.empty())
    for (const Pair& p : pairs) far = std::max(far, p.nearest);
  const int steps = 60;
  std::vector<double> found;
  for (int i = 1; i <= steps; ++i) {
    const double r = far * i / steps;
    double unmatched = 0, expected_unmatched = 0;
    for (const Pair& p : pairs) {
      unmatched += p.nearest > r ? 1 : 0;
      expected_unmatched += std::exp(-3.14159265358979 * p.density * r * r);
    }
    found.push_back(1 - unmatched / std::max(expected_unmatched, 1e-9));
  }
  const double most = *std::max_element(found.begin(), found.end());
  int i = 0;
  while (i + 1 < steps && found[std::size_t(i)] < kFraction * most) ++i;
  const double reach = kMargin * far * (i + 1) / steps;
  if (cut) *cut = !spacing.empty() && reach > far;
  return std::max(kMinReach, std::min(far, reach));
}

}  // namespace faba
