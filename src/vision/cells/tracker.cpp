#include "vision/cells/tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/statistics.h"
#include "vision/cells/assignment.h"

namespace faba {
namespace {

constexpr std::size_t kLookAhead = 12;  // frames, to find reach and motion
constexpr double kGate = 4;             // standard deviations of a forecast
constexpr double kPlaceNoise = 0.15;    // px, least error of a spot's place
constexpr double kForget = 0.98;        // per frame, of what is learnt
constexpr double kBetter = 0.8;         // ratio of squared errors that changes the method of prediction
constexpr double kFewLinks = 20;
constexpr double kUnknownReach = 10;  // px, assumed: where no two neighbouring frames have spots to measure

double place_variance(const Spot& s) { return kPlaceNoise * kPlaceNoise + s.sd_px * s.sd_px; }

// Spots sorted by y: those within `reach` of a place in y.
template <class Visit>
void each_near(const std::vector<Spot>& spots, Vec2 at, double reach, const Visit& visit) {
  auto s = std::lower_bound(spots.begin(), spots.end(), at.y - reach,
                            [](const Spot& a, double y) { return a.y_px < y; });
  for (; s != spots.end() && s->y_px <= at.y + reach; ++s)
    if (std::fabs(s->x_px - at.x) <= reach) visit(std::size_t(s - spots.begin()));
}

}  // namespace

Tracker::Tracker(TrackerOptions options) : options_(options) {
  if (options_.memory < 0 || options_.least_points < 1 || options_.most_points < 2)
    throw Error(Errc::internal, "tracker", "memory, least and most points must not be negative or nothing");
}

void Tracker::take(std::uint64_t frame, double t_s, const std::vector<Spot>& given) {
  if ((begun_ || !waiting_.empty()) && !(t_s > last_t_))
    throw Error(Errc::internal, "tracker", "the time of a frame is not after the one before");
  last_t_ = t_s;
  std::vector<Spot> spots = given;
  std::stable_sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.y_px < b.y_px; });
  if (begun_) return step(frame, t_s, spots);
  waiting_.push_back({frame, t_s, std::move(spots)});
  if (waiting_.size() == kLookAhead) begin();
}

// The first frames are gone through twice: once to learn how things move, once to follow them.
void Tracker::begin() {
  begun_ = true;
  const std::vector<Waiting> first = std::exchange(waiting_, {});
  std::vector<double> gaps;
  for (std::size_t i = 1; i < first.size(); ++i) gaps.push_back(first[i].t_s - first[i - 1].t_s);
  frame_s_ = gaps.empty() ? 1 : median_high(gaps);
  if (!(options_.reach_px > 0)) {
    std::vector<std::vector<Spot>> frames;
    frames.reserve(first.size());
    for (const Waiting& w : first) frames.push_back(w.spots);
    options_.reach_px = displacement_reach(frames, &crowded_);
  }
  const double reach = options_.reach_px;
  scatter_ = reach * reach / 8;
  acceleration_ = reach * reach / 4 / (frame_s_ * frame_s_ * frame_s_);
  motion_ = options_.motion == Motion::velocity ? Motion::velocity : Motion::nearest;
  for (const Waiting& w : first) step(w.frame, w.t_s, w.spots);
  live_.clear();
  finished_.clear();
  numbered_ = dropped_ = 0;
  for (const Waiting& w : first) step(w.frame, w.t_s, w.spots);
}

void Tracker::finish() {
  if (!begun_ && !waiting_.empty()) begin();
  begun_ = true;
  for (Live& l : live_) retire(l);
  live_.clear();
}

std::vector<Track> Tracker::finished() { return std::exchange(finished_, {}); }

std::vector<const Track*> Tracker::live() const {
  std::vector<const Track*> out;
  for (const Live& l : live_)
    if (l.track.number > 0) out.push_back(&l.track);
  return out;
}

Tracker::Forecast Tracker::forecast(const Live& l, double t_s) const {
  const double dt = t_s - l.t_s, frames = dt / frame_s_, reach = options_.reach_px * std::max(1.0, frames);
  const double fresh = reach * reach / (kGate * kGate);
  if (motion_ == Motion::nearest) return {l.at, std::min(fresh, std::max(scatter_ * frames, 1e-3)), reach};
  if (l.points < 2) return {l.at + dt * common_velocity_, fresh, reach};
  const double var = l.var_at + dt * (2 * l.cov + dt * l.var_velocity) + acceleration_ * dt * dt * dt / 3 +
                     kPlaceNoise * kPlaceNoise;
  return {l.at + dt * l.velocity, std::min(var, fresh), std::min(reach, kGate * std::sqrt(var) + 0.5)};
}

// Second round: what is left over may be as far as it can get from where it was.
void Tracker::assign(double t_s, const std::vector<Spot>& spots, bool second, std::vector<int>& of_track,
                     std::vector<bool>& taken) const {
  std::vector<PossiblePair> candidates;
  const double widest = options_.reach_px * options_.reach_px / (kGate * kGate);
  for (std::size_t i = 0; i < live_.size(); ++i) {
    if (of_track[i] >= 0) continue;
    Forecast f = forecast(live_[i], t_s);
    if (second) {
      f.gate = options_.reach_px * std::max(1.0, (t_s - live_[i].t_s) / frame_s_);
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
  error_nearest_ *= kForget;
  error_velocity_ *= kForget;
  weighed_ *= kForget;
  std::vector<Live> kept;
  for (std::size_t i = 0; i < live_.size(); ++i) {
    Live& l = live_[i];
    if (of_track[i] >= 0) {
      follow(l, frame, t_s, spots[std::size_t(of_track[i])]);
    } else if (++l.missed > options_.memory) {
      retire(l);
      continue;
    }
    kept.push_back(std::move(l));
  }
  live_ = std::move(kept);
  for (std::size_t k = 0; k < spots.size(); ++k)
    if (!taken[k]) give_birth(frame, t_s, spots[k]);
  learn_common_velocity();
  if (options_.motion == Motion::automatic && weighed_ > kFewLinks) {
    const double now = motion_ == Motion::nearest ? error_nearest_ : error_velocity_;
    const double other = motion_ == Motion::nearest ? error_velocity_ : error_nearest_;
    if (other < kBetter * now) motion_ = motion_ == Motion::nearest ? Motion::velocity : Motion::nearest;
  }
}

void Tracker::weigh_motion(const Live& l, double dt, Vec2 seen) {
  const Vec2 still = seen - l.at, ahead = seen - (l.at + dt * l.velocity);
  error_nearest_ += dot(still, still);
  error_velocity_ += dot(ahead, ahead);
  weighed_ += 1;
}

void Tracker::follow(Live& l, std::uint64_t frame, double t_s, const Spot& spot) {
  const double dt = t_s - l.t_s, frames = dt / frame_s_, r = place_variance(spot);
  const Vec2 seen{spot.x_px, spot.y_px};
  if (l.points > 2) weigh_motion(l, dt, seen);
  const Vec2 moved = seen - l.at;
  scatter_ += 0.002 * (0.5 * dot(moved, moved) / frames - scatter_);
  if (l.points < 2) {
    l.velocity = (1 / dt) * moved;
    l.at = seen;
    l.var_at = r;
    l.cov = r / dt;
    l.var_velocity = 2 * r / (dt * dt) + acceleration_ * dt / 3;
  } else {
    // Kalman filter of one axis; both axes have the same variances.
    const double q = acceleration_ * dt;
    const double paa = l.var_at + dt * (2 * l.cov + dt * l.var_velocity) + q * dt * dt / 3;
    const double pav = l.cov + dt * l.var_velocity + q * dt / 2, pvv = l.var_velocity + q;
    const Vec2 innovation = seen - (l.at + dt * l.velocity);
    const double s = paa + r, ka = paa / s, kv = pav / s;
    l.at = l.at + dt * l.velocity + ka * innovation;
    l.velocity = l.velocity + kv * innovation;
    l.var_at = (1 - ka) * paa;
    l.cov = (1 - ka) * pav;
    l.var_velocity = pvv - kv * pav;
    // How restless things are follows from how far the forecasts were off: 2 s is expected of |innovation|^2.
    const double off = std::min(dot(innovation, innovation) / (2 * s), kGate * kGate);
    acceleration_ *= 1 + 0.002 * (off - 1);
  }
  // Filtered places lag behind; what is predicted from them is better, what is known of the last place is
  // not.
  if (motion_ == Motion::nearest) l.at = seen;
  l.t_s = t_s;
  l.missed = 0;
  ++l.points;
  l.track.points.push_back({frame, t_s, spot.x_px, spot.y_px, spot.mass, spot.snr});
  if (l.points == std::size_t(options_.least_points)) l.track.number = ++numbered_;
  if (l.track.points.size() >= std::size_t(options_.most_points) && l.track.number > 0) {
    l.track.continues = true;
    finished_.push_back(l.track);
    l.track.continues = false;
    l.track.points.clear();
  }
}

void Tracker::give_birth(std::uint64_t frame, double t_s, const Spot& spot) {
  Live l;
  l.at = {spot.x_px, spot.y_px};
  l.t_s = t_s;
  l.points = 1;
  l.track.points.push_back({frame, t_s, spot.x_px, spot.y_px, spot.mass, spot.snr});
  if (options_.least_points == 1) l.track.number = ++numbered_;
  live_.push_back(std::move(l));
}

void Tracker::retire(Live& l) {
  if (l.track.number == 0)
    ++dropped_;
  else if (!l.track.points.empty())
    finished_.push_back(std::move(l.track));
}

void Tracker::learn_common_velocity() {
  std::vector<double> x, y;
  for (const Live& l : live_)
    if (l.points >= 3) {
      x.push_back(l.velocity.x);
      y.push_back(l.velocity.y);
    }
  if (double(x.size()) < kFewLinks) return;
  common_velocity_ = {median_high(x), median_high(y)};
}

double displacement_reach(const std::vector<std::vector<Spot>>& frames, bool* cut) {
  constexpr int kNth = 6;  // neighbour that the density around a spot is taken from
  constexpr double kShare = 0.95, kMore = 1.25, kLeast = 2, kSpacings = 0.75;
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
      // One of them is the spot itself, a frame later.
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
    double none = 0, none_by_chance = 0;
    for (const Pair& p : pairs) {
      none += p.nearest > r ? 1 : 0;
      none_by_chance += std::exp(-3.14159265358979 * p.density * r * r);
    }
    found.push_back(1 - none / std::max(none_by_chance, 1e-9));
  }
  const double most = *std::max_element(found.begin(), found.end());
  int i = 0;
  while (i + 1 < steps && found[std::size_t(i)] < kShare * most) ++i;
  const double reach = kMore * far * (i + 1) / steps;
  if (cut) *cut = !spacing.empty() && reach > far;
  return std::max(kLeast, std::min(far, reach));
}

}  // namespace faba
