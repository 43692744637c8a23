#include "study/tracks/track_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/units.h"
#include "study/stats/statistics.h"
#include "study/tracks/track_bins.h"
#include "study/tracks/track_sums.h"

namespace faba {
namespace {

constexpr std::size_t kGroups = 20;  // groups of tracks for the jackknife, by track number
constexpr std::size_t kPilotPoints = 50000;
constexpr double kLowSpeed = 1e-4;  // lower edge of the logarithmic bins, px per interval
constexpr double kBinsPerDecade = 400;
constexpr std::size_t kSpeedBins = 3600, kTurnBins = 720;
constexpr std::size_t kScales[] = {1, 2, 4, 8};  // time scales of the test for persistence, frames
constexpr std::size_t kMostMemory = 12;          // longest correlation of positions by blur or codec, frames
constexpr double kClear = 3;                     // standard errors
constexpr double kKept = 0.2;  // of the squared displacement; 0.2 is a persistence time of one frame

// 1 to 8, then in steps of a quarter.
std::vector<int> lags_up_to(int most) {
  std::vector<int> lags;
  for (int k = 1; k <= most; k = k < 8 ? k + 1 : std::max(k + 1, k + k / 4)) lags.push_back(k);
  return lags;
}

// The law of a fit at the lags of a mean-square displacement.
template <class Law>
FittedMsd fitted_msd(const Msd& m, const Law& law) {
  FittedMsd f{m, {}};
  for (const double lag : m.lag_s) f.law_px2.push_back(law(lag));
  return f;
}

}  // namespace

struct TrackStatistics::Impl {
  double frame_s;
  int interval = 0;
  bool has_interval = false;
  double noise2 = 0;  // variance of a detected position per axis, px^2
  std::vector<int> lags;
  std::vector<TrackGroup> groups = std::vector<TrackGroup>(kGroups);
  std::vector<Track> pilot;
  std::size_t pilot_points = 0;
  std::uint64_t points = 0;
  double track_count = 0;
  std::vector<double> speed_bins = std::vector<double>(kSpeedBins),
                      turn_bins = std::vector<double>(kTurnBins);
  VelocitySums velocity;
  TimeBins in_time;

  Impl(double frame, int frames) : frame_s(frame), interval(frames), lags(lags_up_to(400)), in_time(frame) {
    for (TrackGroup& g : groups) {
      g.lags.resize(lags.size());
      for (const std::size_t m : kScales) g.kept.push_back({m, 2 * m});
      for (std::size_t k = 2; k <= kMostMemory; ++k) g.memory.push_back({1, k});
    }
  }

  void add_displacements(const Track& t);
  void add_motion(const Track& t);
  void set_interval();
  LagSums all(std::size_t lag) const;
  Msd msd_without(const TrackGroup* left_out) const;
  Estimated product(std::size_t which, std::vector<ProductSums> TrackGroup::*list) const;
  void test_persistence(TrackSummary& s) const;
  void fit(TrackSummary& s) const;
  std::size_t fit_all(TrackSummary& s) const;
  void fit_without_groups(TrackSummary& s, double offset, std::size_t skipped) const;
  void motion(TrackSummary& s) const;
};

LagSums TrackStatistics::Impl::all(std::size_t lag) const {
  LagSums sum;
  for (const TrackGroup& g : groups) sum += g.lags[lag];
  return sum;
}

void TrackStatistics::Impl::add_displacements(const Track& t) {
  TrackGroup& g = groups[t.number % kGroups];
  const std::vector<int> slots = slots_of(t, frame_s);
  const auto seen = [&](std::size_t slot) { return slot < slots.size() ? slots[slot] : -1; };
  for (std::size_t k = 0; k < lags.size(); ++k) {
    LagSums& sum = g.lags[k];
    for (std::size_t i = 0; i + std::size_t(lags[k]) < slots.size(); ++i) {
      const int a = seen(i), b = seen(i + std::size_t(lags[k]));
      if (a < 0 || b < 0) continue;
      const TrackPoint &p = t.points[std::size_t(a)], &q = t.points[std::size_t(b)];
      const double dx = q.x_px - p.x_px, dy = q.y_px - p.y_px;
      sum += {1, q.t_s - p.t_s, dx, dy, dx * dx + dy * dy};
    }
  }
  const auto place = [&](int at) {
    return Vec2{t.points[std::size_t(at)].x_px, t.points[std::size_t(at)].y_px};
  };
  for (auto* products : {&g.kept, &g.memory})
    for (ProductSums& p : *products)
      for (std::size_t i = 0; i + p.apart + p.over < slots.size(); ++i) {
        const int a = slots[i], b = slots[i + p.over], c = slots[i + p.apart],
                  d = slots[i + p.apart + p.over];
        if (a < 0 || b < 0 || c < 0 || d < 0) continue;
        p.n += 1;
        p.dot += dot(place(b) - place(a), place(d) - place(c));
      }
}

// Speeds and turns over the interval, from consecutive displacements.
void TrackStatistics::Impl::add_motion(const Track& t) {
  TrackGroup& g = groups[t.number % kGroups];
  const std::vector<int> slots = slots_of(t, frame_s);
  const auto step = std::size_t(interval);
  Vec2 last;
  bool has_last = false;
  for (std::size_t i = 0; i + step < slots.size(); i += step) {
    const int a = slots[i], b = slots[i + step];
    if (a < 0 || b < 0) {
      has_last = false;
      continue;
    }
    const TrackPoint &p = t.points[std::size_t(a)], &q = t.points[std::size_t(b)];
    const Vec2 d{q.x_px - p.x_px, q.y_px - p.y_px};
    const double dt = q.t_s - p.t_s;
    // The localisation error across the direction of motion increases the length of displacements, that along
    // it does not (theory H2).
    const double length = std::sqrt(std::max(0.0, dot(d, d) - 2 * noise2)), v = length / dt;
    g.speed.n += 1;
    g.speed.v += v;
    const double bin = length > kLowSpeed ? kBinsPerDecade * std::log10(length / kLowSpeed) : 0;
    speed_bins[std::min(kSpeedBins - 1, std::size_t(bin))] += 1;
    velocity.take((1 / dt) * d);
    const bool clear = dot(d, d) > 9 * 2 * noise2 && dot(d, d) > 0;
    if (clear && has_last) {
      const double turn = std::atan2(last.x * d.y - last.y * d.x, dot(last, d));
      g.turn.n += 1;
      g.turn.size += std::fabs(turn) / dt;
      g.turn.with_sign += turn / dt;
      turn_bins[std::min(kTurnBins - 1,
                         std::size_t(std::fabs(turn) / std::numbers::pi * double(kTurnBins)))] += 1;
    }
    last = d;
    has_last = clear;
  }
  for (std::size_t i = 0; i + step < slots.size(); ++i) {  // overlapping: all times have equal weight
    if (slots[i] < 0 || slots[i + step] < 0) continue;
    const TrackPoint &p = t.points[std::size_t(slots[i])], &q = t.points[std::size_t(slots[i + step])];
    const double dt = q.t_s - p.t_s;
    in_time.add(0.5 * (p.t_s + q.t_s), (q.x_px - p.x_px) / dt, (q.y_px - p.y_px) / dt);
  }
}

Msd TrackStatistics::Impl::msd_without(const TrackGroup* left_out) const {
  Msd m;
  double first = 0;
  for (std::size_t k = 0; k < lags.size(); ++k) {
    LagSums sum = all(k);
    if (k == 0) first = sum.n;
    if (sum.n < 20 || sum.n < 0.02 * first) break;
    double se = 0;
    if (left_out) {
      sum = sum.without(left_out->lags[k]);
      if (sum.n < 2) break;
    } else {
      se = jackknife_se(groups, [&](const TrackGroup& g) {
        const LagSums rest = sum.without(g.lags[k]);
        return rest.n > 1 ? rest.msd() : sum.msd();
      });
    }
    m.lag_s.push_back(sum.dt / sum.n);
    m.msd_px2.push_back(sum.msd());
    m.se_px2.push_back(se);
    m.pairs.push_back(sum.n);
  }
  return m;
}

// Mean product of two displacements, minus the contribution of the common drift.
Estimated TrackStatistics::Impl::product(std::size_t which,
                                         std::vector<ProductSums> TrackGroup::*list) const {
  const auto without = [&](const TrackGroup* left_out) {
    double n = 0, sum = 0, over = 0;
    for (const TrackGroup& g : groups)
      if (&g != left_out) {
        n += (g.*list)[which].n;
        sum += (g.*list)[which].dot;
        over = double((g.*list)[which].over);
      }
    LagSums one = all(0);
    if (left_out) one = one.without(left_out->lags[0]);
    if (n < 1 || one.n < 1) return kNaN;
    const Vec2 drift{over * one.dx / one.n, over * one.dy / one.n};
    return sum / n - dot(drift, drift);
  };
  return {without(nullptr), jackknife_se(groups, [&](const TrackGroup& g) { return without(&g); })};
}

void TrackStatistics::Impl::test_persistence(TrackSummary& s) const {
  s.persistence = {0, kNaN};
  for (std::size_t i = 0; i < std::size(kScales); ++i) {
    const auto lag = std::size_t(std::find(lags.begin(), lags.end(), int(kScales[i])) - lags.begin());
    if (lag >= s.msd.size()) break;
    const Estimated p = product(i, &TrackGroup::kept);
    const double fraction = p.value / s.msd.msd_px2[lag], se = p.se / s.msd.msd_px2[lag];
    // Without a standard error (too few tracks) twice the limit is required.
    const bool clear = std::isfinite(se) ? fraction > kClear * se && fraction > kKept : fraction > 2 * kKept;
    if (clear) s.persists = true;
    if (fraction > s.persistence.value) {
      s.persistence = {fraction, se};
      s.persistence_scale_s = s.msd.lag_s[lag];
    }
  }
  for (std::size_t k = 0; k < kMostMemory - 1; ++k) {
    const Estimated p = product(k, &TrackGroup::memory);
    if (!(p.value > kClear * p.se)) break;
    s.memory_frames = int(k) + 2;
  }
}

void TrackStatistics::Impl::fit(TrackSummary& s) const {
  const std::size_t skipped = fit_all(s);
  const LagSums one = all(0);
  const auto drift = [&](bool x) {
    const auto value = [&](const LagSums& l) { return l.dt > 0 ? (x ? l.dx : l.dy) / l.dt : kNaN; };
    return Estimated{
        value(one), jackknife_se(groups, [&](const TrackGroup& g) { return value(one.without(g.lags[0])); })};
  };
  s.drift_x_px_s = drift(true);
  s.drift_y_px_s = drift(false);
  const double offset = s.persists && s.persistent.good ? s.persistent.offset_px2 : s.diffusion.offset_px2;
  fit_without_groups(s, offset, skipped);
}

// The fits to the displacements of all groups, without their errors. Returns the number of skipped lags.
std::size_t TrackStatistics::Impl::fit_all(TrackSummary& s) const {
  s.msd = msd_without(nullptr);
  test_persistence(s);
  const auto skipped =
      s.persists ? 0
                 : std::size_t(std::lower_bound(lags.begin(), lags.end(), s.memory_frames) - lags.begin());
  s.diffusion = fit_diffusion(s.msd, skipped);
  s.persistent = fit_persistent(s.msd);
  const double offset = s.persists && s.persistent.good ? s.persistent.offset_px2 : s.diffusion.offset_px2;
  s.localisation_px = std::sqrt(std::max(0.0, offset / 4));
  return skipped;
}

// Standard errors and misfit: the same lags and weights with each group left out.
void TrackStatistics::Impl::fit_without_groups(TrackSummary& s, double offset, std::size_t skipped) const {
  std::vector<double> d, speed, tau, alpha;
  std::vector<FittedMsd> diffusion, persistent;
  const auto with = [](const auto& fit, double (*law)(decltype(fit), double)) {
    return [&fit, law](double lag) { return law(fit, lag); };
  };
  for (const TrackGroup& g : groups) {
    if (!(g.tracks > 0)) continue;
    Msd m = msd_without(&g);
    for (std::size_t k = 0; k < m.size(); ++k) m.se_px2[k] = s.msd.se_px2[k];
    const DiffusionFit straight = fit_diffusion(m, s.diffusion.first, s.diffusion.lags);
    const PersistentFit walk = fit_persistent(m);
    d.push_back(straight.d_px2_s);
    speed.push_back(walk.speed_px_s);
    tau.push_back(walk.tau_s);
    alpha.push_back(fit_exponent(m, offset, skipped));
    diffusion.push_back(fitted_msd(m, with(straight, diffusion_msd)));
    persistent.push_back(fitted_msd(m, with(walk, persistent_msd)));
  }
  s.d_px2_s = {s.diffusion.d_px2_s, jackknife_se(d)};
  s.speed_rms_px_s = {s.persistent.speed_px_s, jackknife_se(speed)};
  s.tau_s = {s.persistent.tau_s, s.persistent.tau_open ? kNaN : jackknife_se(tau)};
  s.alpha = {fit_exponent(s.msd, offset, skipped), jackknife_se(alpha)};
  if (s.diffusion.good)
    s.diffusion_misfit = msd_misfit(fitted_msd(s.msd, with(s.diffusion, diffusion_msd)), diffusion,
                                    s.diffusion.first, last_compared(s.msd, s.diffusion));
  if (s.persistent.good)
    s.persistent_misfit =
        msd_misfit(fitted_msd(s.msd, with(s.persistent, persistent_msd)), persistent, 0, s.msd.size() - 1);
}

void TrackStatistics::Impl::set_interval() {
  has_interval = true;
  TrackSummary s;
  fit_all(s);
  noise2 = s.localisation_px * s.localisation_px;
  if (interval <= 0) {
    interval = 1;
    const double enough = 100 * 2 * noise2;
    const double most_s = s.persists && s.persistent.good ? 0.1 * s.persistent.tau_s : frame_s;
    for (std::size_t k = 0; k < s.msd.size(); ++k) {
      if (k > 0 && s.msd.lag_s[k] > most_s) break;
      interval = lags[k];
      if (s.msd.msd_px2[k] - 4 * noise2 > enough) break;
    }
  }
  for (const Track& t : pilot) add_motion(t);
  pilot.clear();
}

void TrackStatistics::Impl::motion(TrackSummary& s) const {
  s.interval_frames = interval;
  s.interval_s = interval * frame_s;
  const auto mean_of = [&](const auto& n_of, const auto& sum_of, double scale) {
    double n = 0, sum = 0;
    for (const TrackGroup& g : groups) {
      n += n_of(g);
      sum += sum_of(g);
    }
    if (n < 1) return Estimated{kNaN, kNaN};
    const auto rest = [&](const TrackGroup& g) {
      return n - n_of(g) > 0 ? scale * (sum - sum_of(g)) / (n - n_of(g)) : kNaN;
    };
    return Estimated{scale * sum / n, jackknife_se(groups, rest)};
  };
  s.mean_speed_px_s = mean_of([](const TrackGroup& g) { return g.speed.n; },
                              [](const TrackGroup& g) { return g.speed.v; }, 1);
  s.turn_deg_s = mean_of([](const TrackGroup& g) { return g.turn.n; },
                         [](const TrackGroup& g) { return g.turn.size; }, kDegreesPerRadian);
  s.signed_turn_deg_s = mean_of([](const TrackGroup& g) { return g.turn.n; },
                                [](const TrackGroup& g) { return g.turn.with_sign; }, kDegreesPerRadian);
  for (const TrackGroup& g : groups) {
    s.speed_count += std::uint64_t(g.speed.n);
    s.turn_count += std::uint64_t(g.turn.n);
  }
  const auto speed_at = [&](double bin) {
    return bin < 1 ? 0.0 : kLowSpeed * std::pow(10, bin / kBinsPerDecade) / s.interval_s;
  };
  const auto turn_at = [&](double bin) { return bin / double(kTurnBins) * 180 / s.interval_s; };
  for (const double q : {0.1, 0.5, 0.9}) {
    s.speed_quantiles_px_s.push_back(binned_quantile(speed_bins, q, speed_at));
    s.turn_quantiles_deg_s.push_back(binned_quantile(turn_bins, q, turn_at));
  }
  s.velocity_isotropy = velocity.isotropy();
  s.order = velocity.length > 0 ? norm(velocity.sum) / velocity.length : kNaN;
  const double typical = s.speed_quantiles_px_s[1] * s.interval_s;
  if (typical > 0)
    s.turn_noise_deg_s =
        std::sqrt(2 / std::numbers::pi) * kDegreesPerRadian * std::sqrt(6 * noise2) / typical / s.interval_s;
  for (const TimeBins::Span& span : in_time.spans()) {
    s.time_s.push_back(span.time_s);
    s.count_in_time.push_back(span.count);
    s.velocity_x_px_s.push_back(span.x);
    s.velocity_y_px_s.push_back(span.y);
    s.order_in_time.push_back(span.order);
  }
  // Bins of equal width up to the 99.5 % quantile; faster displacements are in the last bin.
  const double most = binned_quantile(speed_bins, 0.995, speed_at);
  if (!(most > 0)) return;
  const auto bins = std::size_t(std::clamp(std::sqrt(double(s.speed_count)), 8.0, 40.0));
  s.speeds_px_s.counts.resize(bins);
  for (std::size_t i = 0; i <= bins; ++i) s.speeds_px_s.edges.push_back(most * double(i) / double(bins));
  for (std::size_t i = 0; i < kSpeedBins; ++i) {
    const double v = speed_at(double(i) + 0.5);
    if (v <= most)
      s.speeds_px_s.counts[std::min(bins - 1, std::size_t(v / most * double(bins)))] += speed_bins[i];
  }
}

TrackStatistics::TrackStatistics(double frame_s, int interval_frames)
    : impl_(std::make_unique<Impl>(frame_s, interval_frames)) {}
TrackStatistics::~TrackStatistics() = default;
TrackStatistics::TrackStatistics(TrackStatistics&&) noexcept = default;
TrackStatistics& TrackStatistics::operator=(TrackStatistics&&) noexcept = default;

void TrackStatistics::take(const Track& track) {
  Impl& me = *impl_;
  if (track.points.empty()) return;
  me.points += track.points.size();
  if (!track.continues) {
    me.track_count += 1;
    me.groups[track.number % kGroups].tracks += 1;
  }
  me.add_displacements(track);
  if (me.has_interval) return me.add_motion(track);
  me.pilot.push_back(track);
  me.pilot_points += track.points.size();
  if (me.pilot_points >= kPilotPoints) me.set_interval();
}

TrackSummary TrackStatistics::summary() {
  Impl& me = *impl_;
  TrackSummary s;
  s.tracks = std::uint64_t(me.track_count);
  s.points = me.points;
  s.mean_points = me.track_count > 0 ? double(me.points) / me.track_count : 0;
  if (me.points == 0) return s;
  if (!me.has_interval) me.set_interval();
  me.fit(s);
  me.motion(s);
  return s;
}

}  // namespace faba
