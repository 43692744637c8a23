#include "study/tracks/populations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "core/random/splitmix64.h"
#include "core/statistics.h"

namespace faba {
namespace {

constexpr std::size_t kMostWindows = 20000;
constexpr std::size_t kFewWindows = 5;
constexpr int kWindowLags = 4;
constexpr std::size_t kMostComponents = 3;
constexpr double kSmallest = 0.05;  // fraction of a population
// Of one of three: a third component also fits the flank of a skewed distribution.
constexpr double kSmallestOfThree = 0.15;
constexpr double kLeastPenalty = 2;       // per parameter, for few tracks: that of Akaike's criterion
constexpr double kSeparation = 2;         // Ashman's D: two normal distributions have two maxima above it
constexpr double kLeastLogSpread = 0.05;  // of the logarithm of the speed
// Width of the bins of the logarithm for the fit: a tenth of the least spread, whose variance they change by
// 0.1 %.
constexpr double kBin = 0.1 * kLeastLogSpread;
constexpr double kStill = 2;                 // localisation errors of a displacement (97.7 %)
constexpr double kTogether = 0.5;            // mean velocity over speed, of a drift
constexpr double kLeastDisplacement = 0.02;  // px, of a well resolved spot
constexpr double kOneSidedSd90 = 1.645;

struct Sample {
  double log_speed = 0, weight = 0;
};

struct Component {
  double weight = 0, mean = 0, sd = 1;
};

// The density of a component, for many values.
class Density {
 public:
  explicit Density(const Component& c)
      : mean_(c.mean), per_sd_(1 / c.sd), peak_(c.weight / (c.sd * std::sqrt(2 * std::numbers::pi))) {}
  double operator()(double x) const {
    const double z = (x - mean_) * per_sd_;
    return peak_ * std::exp(-0.5 * z * z);
  }

 private:
  double mean_, per_sd_, peak_;
};
using Mixture = std::vector<Component>;

double log_likelihood(const std::vector<Sample>& samples, const Mixture& m) {
  const std::vector<Density> densities(m.begin(), m.end());
  double sum = 0;
  for (const Sample& s : samples) {
    double p = 0;
    for (const Density& density : densities) p += density(s.log_speed);
    sum += s.weight * std::log(std::max(p, 1e-300));
  }
  return sum;
}

// Expectation maximisation from components at equally spaced quantiles. `samples` are sorted; their weights
// add up to their effective number.
Mixture fitted(const std::vector<Sample>& samples, std::size_t components) {
  constexpr int kIterations = 200;
  constexpr double kConverged = 1e-7;  // of the mean of a logarithm, and of a weight
  double total = 0, mean = 0, square = 0;
  for (const Sample& s : samples) {
    total += s.weight;
    mean += s.weight * s.log_speed;
    square += s.weight * s.log_speed * s.log_speed;
  }
  mean /= total;
  const double sd = std::max(kLeastLogSpread, std::sqrt(std::max(0.0, square / total - mean * mean)));
  Mixture m(components);
  const double low = samples.front().log_speed, high = samples.back().log_speed;
  for (std::size_t k = 0; k < components; ++k)
    m[k] = {1 / double(components),
            components == 1 ? mean : low + (high - low) * (double(k) + 0.5) / double(components),
            components == 1 ? sd : std::max(kLeastLogSpread, sd / double(components))};
  for (int i = 0; i < kIterations && components > 1; ++i) {
    std::vector<std::array<double, 3>> sums(components);  // weight, first and second moment
    const std::vector<Density> densities(m.begin(), m.end());
    std::array<double, kMostComponents> density{};
    for (const Sample& s : samples) {
      double p = 0;
      for (std::size_t k = 0; k < components; ++k) {
        density[k] = densities[k](s.log_speed);
        p += density[k];
      }
      if (!(p > 0)) continue;
      for (std::size_t k = 0; k < components; ++k) {
        const double w = s.weight * density[k] / p;
        sums[k][0] += w;
        sums[k][1] += w * s.log_speed;
        sums[k][2] += w * s.log_speed * s.log_speed;
      }
    }
    double change = 0;
    for (std::size_t k = 0; k < components; ++k) {
      const double w = std::max(sums[k][0], 1e-9 * total);
      const double centre = sums[k][1] / w;
      change = std::max({change, std::fabs(w / total - m[k].weight), std::fabs(centre - m[k].mean)});
      m[k] = {w / total, centre,
              std::max(kLeastLogSpread, std::sqrt(std::max(0.0, sums[k][2] / w - centre * centre)))};
    }
    if (change < kConverged) break;
  }
  std::sort(m.begin(), m.end(), [](const Component& a, const Component& b) { return a.mean < b.mean; });
  return m;
}

// The samples of each bin together, at their mean: many windows have a few hundred different speeds.
// `samples` are sorted.
std::vector<Sample> binned(const std::vector<Sample>& samples) {
  std::vector<Sample> bins;
  double end = -std::numeric_limits<double>::infinity();
  for (const Sample& s : samples) {
    if (s.log_speed >= end) {
      bins.push_back({});
      end = s.log_speed + kBin;
    }
    Sample& bin = bins.back();
    bin.weight += s.weight;
    if (bin.weight > 0) bin.log_speed += (s.log_speed - bin.log_speed) * s.weight / bin.weight;
  }
  return bins;
}

bool separated(const Mixture& m) {
  for (std::size_t k = 0; k < m.size(); ++k) {
    if (m[k].weight < (m.size() > 2 ? kSmallestOfThree : kSmallest)) return false;
    if (k == 0) continue;
    const double spread = std::sqrt(0.5 * (m[k].sd * m[k].sd + m[k - 1].sd * m[k - 1].sd));
    if (m[k].mean - m[k - 1].mean < kSeparation * spread) return false;
  }
  return true;
}

Mixture chosen(const std::vector<Sample>& all, Pool& pool) {
  const std::vector<Sample> samples = binned(all);
  double n = 0;
  for (const Sample& s : samples) n += s.weight;
  const auto criterion = [&](const Mixture& m) {
    return -2 * log_likelihood(samples, m) +
           (3 * double(m.size()) - 1) * std::max(kLeastPenalty, std::log(n));
  };
  const std::size_t most = std::clamp<std::size_t>(all.size() / kFewWindows, 1, kMostComponents);
  std::array<Mixture, kMostComponents> fits;
  pool.run_uneven(most, [&](std::size_t i) { fits[most - 1 - i] = fitted(samples, most - i); });
  Mixture best = fits[0];
  for (std::size_t k = 1; k < most; ++k)
    if (separated(fits[k]) && criterion(fits[k]) < criterion(best)) best = fits[k];
  return best;
}

std::size_t most_probable(const Mixture& m, double x) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < m.size(); ++k)
    if (Density(m[k])(x) > Density(m[best])(x)) best = k;
  return best;
}

// 90 % interval of the median: the quantiles between which it lies in 90 % of samples of `n` independent
// values (normal approximation of the binomial distribution).
std::array<double, 2> median_interval(const std::vector<double>& values, double n) {
  const double half = 0.5 * kOneSidedSd90 / std::sqrt(std::max(1.0, n));
  return {quantile(values, std::max(0.0, 0.5 - half)), quantile(values, std::min(1.0, 0.5 + half))};
}

// The windows of a component of the mixture.
struct Members {
  std::vector<double> speeds;
  std::set<std::uint32_t> tracks;
  Vec2 velocity;  ///< sum
  PopulationMotion motion = PopulationMotion::moving;
  void merge(const Members& o) {
    speeds.insert(speeds.end(), o.speeds.begin(), o.speeds.end());
    tracks.insert(o.tracks.begin(), o.tracks.end());
    velocity = velocity + o.velocity;
  }
};

}  // namespace

const char* word_of(PopulationMotion motion) {
  return motion == PopulationMotion::moving  ? "moving"
         : motion == PopulationMotion::still ? "still"
                                             : "drifting";
}

void PopulationSurvey::take(const Track& track) {
  if (!(frame_s_ > 0)) return;
  for (std::size_t lag = 0; lag < kLags.size(); ++lag) take(track, lag);
}

void PopulationSurvey::take(const Track& track, std::size_t lag) {
  const auto step = std::uint64_t(kLags[lag]), length = kWindowLags * step;
  const std::vector<TrackPoint>& points = track.points;
  for (std::size_t begin = 0; begin < points.size();) {
    const std::uint64_t end_frame = points[begin].frame + length;
    std::size_t last = begin, later = begin;
    double n = 0, sum = 0;
    for (std::size_t i = begin; i < points.size() && points[i].frame <= end_frame; last = i++) {
      while (later < points.size() && points[later].frame < points[i].frame + step) ++later;
      if (later == points.size() || points[later].frame > end_frame) continue;
      if (points[later].frame != points[i].frame + step) continue;
      const Vec2 d{points[later].x_px - points[i].x_px, points[later].y_px - points[i].y_px};
      sum += norm(d);
      n += 1;
    }
    const double seconds = points[last].t_s - points[begin].t_s;
    // At least half of the displacements of the window were seen.
    if (seconds > 0 && 2 * n > double(length - step)) {
      Windows& all = windows_[lag];
      const Window w{float(sum / n * sum / n), float((points[last].x_px - points[begin].x_px) / seconds),
                     float((points[last].y_px - points[begin].y_px) / seconds), std::uint32_t(track.number)};
      // A random selection of all windows, the same in every run.
      ++all.seen;
      const std::uint64_t at = splitmix64(all.seen * kSplitMix64Step) % all.seen;
      if (all.kept.size() < kMostWindows)
        all.kept.push_back(w);
      else if (at < kMostWindows)
        all.kept[std::size_t(at)] = w;
    }
    if (last == begin) break;
    begin = last;
  }
}

std::vector<SpeedPopulation> PopulationSurvey::populations(int interval, double localisation_px,
                                                           Pool& pool) const {
  const auto lag = std::size_t(
      std::min<std::ptrdiff_t>(std::lower_bound(kLags.begin(), kLags.end(), interval) - kLags.begin(),
                               std::ptrdiff_t(kLags.size()) - 1));
  const std::vector<Window>& windows = windows_[lag].kept;
  if (windows.size() < kFewWindows) return {};
  const double seconds = kLags[lag] * frame_s_,
               noise2 = std::numbers::pi * localisation_px *
                        localisation_px;  // squared mean of displacements by errors
  // Slower objects are not distinguished.
  const double least = std::max(kLeastDisplacement, std::sqrt(noise2)) / seconds;
  std::set<std::uint32_t> tracks;
  std::vector<Sample> samples;
  for (const Window& w : windows) {
    tracks.insert(w.track);
    const double speed = std::sqrt(std::max(0.0, double(w.square) - noise2)) / seconds;
    samples.push_back({std::log(std::max(speed, least)), 1});
  }
  std::vector<Sample> sorted = samples;
  for (Sample& s : sorted) s.weight = double(tracks.size()) / double(windows.size());
  std::sort(sorted.begin(), sorted.end(),
            [](const Sample& a, const Sample& b) { return a.log_speed < b.log_speed; });
  const Mixture mixture = chosen(sorted, pool);
  std::vector<Members> groups(mixture.size());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    Members& g = groups[most_probable(mixture, samples[i].log_speed)];
    g.speeds.push_back(std::sqrt(std::max(0.0, double(windows[i].square) - noise2)) / seconds);
    g.tracks.insert(windows[i].track);
    g.velocity = g.velocity + Vec2{double(windows[i].vx), double(windows[i].vy)};
  }
  std::erase_if(groups, [](const Members& g) { return g.speeds.empty(); });
  for (Members& g : groups)
    if (median(g.speeds) <= kStill * least) g.motion = PopulationMotion::still;
  // The slowest group that moves in one direction, if there are faster ones, is carried along.
  Members& slowest = groups.front();
  if (groups.size() > 1 && slowest.motion == PopulationMotion::moving &&
      norm(slowest.velocity) > kTogether * double(slowest.speeds.size()) * median(slowest.speeds))
    slowest.motion = PopulationMotion::drifting;
  for (std::size_t k = 1; k < groups.size();)  // speeds below the localisation error are one population
    if (groups[k].motion == PopulationMotion::still && groups[k - 1].motion == PopulationMotion::still) {
      groups[k - 1].merge(groups[k]);
      groups.erase(groups.begin() + std::ptrdiff_t(k));
    } else {
      ++k;
    }
  std::vector<SpeedPopulation> out;
  out.reserve(groups.size());
  for (const Members& g : groups)
    out.push_back({double(g.speeds.size()) / double(windows.size()), median(g.speeds),
                   median_interval(g.speeds, double(g.tracks.size())), g.motion, g.tracks.size()});
  return out;
}

}  // namespace faba
