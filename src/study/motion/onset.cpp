#include "study/motion/onset.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random/distributions.h"
#include "core/statistics.h"

namespace faba {
namespace {

constexpr double kSteady = 0.6;      // s of constant velocity before the change, assumed
constexpr double kSmooth = 0.15;     // s over which velocities are averaged to find the maximum
constexpr double kHalfRises = 3;     // length of the window after the change, in times to half of the rise
constexpr double kLeastAfter = 0.4;  // s of that window, at least
constexpr std::size_t kPairsBefore = 3, kPairsAfter = 8;
constexpr std::size_t kWindowBlocks = 6;  // of the window, assumed independent
constexpr double kIndependent = 0.5;      // s between changes that are assumed independent
constexpr double kPerPair = 10;           // steps of the onset per pair
constexpr double kModelError = 0.05;  // of the rise: rms deviation of a logistic rise from the nearest ramp
struct ChangeWindow {
  std::size_t begin = 0, change = 0, end = 0;
  double half_s = 0;  ///< time at which the smoothed velocity has half of its rise
  double pair_s = 0;  ///< mean duration of a pair
};

double mean_of(std::span<const double> v, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += v[k];
  return sum / double(to - from);
}

std::optional<ChangeWindow> window_of(const ShiftSeries& s, double earliest, double latest) {
  ChangeWindow w;
  const std::size_t n = s.t0_s.size();
  constexpr double kSlack = 1e-6;  // s: rounding of time stamps
  while (w.change < n && s.t1_s[w.change] <= earliest + kSlack) ++w.change;
  w.begin = w.change;
  while (w.begin > 0 && s.t0_s[w.begin - 1] >= earliest - kSteady) --w.begin;
  std::size_t last = w.change;
  while (last < n && s.t1_s[last] <= latest + kSlack) ++last;
  if (w.change - w.begin < kPairsBefore || last < w.change + kPairsAfter) return {};
  w.pair_s = (s.t1_s[last - 1] - s.t0_s[w.begin]) / double(last - w.begin);
  const std::size_t wide = std::max<std::size_t>(3, std::size_t(kSmooth / w.pair_s));
  const double before = mean_of(s.along, w.begin, w.change);
  double most = 0;
  std::vector<double> smooth;
  for (std::size_t k = w.change; k + wide <= last; ++k) {
    smooth.push_back(mean_of(s.along, k, k + wide) - before);
    most = std::max(most, smooth.back());
  }
  if (!(most > 0)) return {};
  std::size_t half = 0;
  while (smooth[half] < most / 2) ++half;
  const std::size_t middle = w.change + half + wide / 2;
  w.half_s = (s.t0_s[middle] + s.t1_s[middle]) / 2;
  const double length = std::max(kLeastAfter, kHalfRises * (w.half_s - earliest));
  w.end = std::max(w.change + kPairsAfter, middle + kPairsBefore);
  while (w.end < last && s.t1_s[w.end] <= earliest + length) ++w.end;
  w.end = std::min(w.end, last);
  return w;
}

// Integral from minus infinity to t of a ramp that starts at `a` and is 1 after `rise`.
double ramp_integral(double t, double a, double rise) {
  const double u = std::max(0.0, t - a);
  return u < rise ? u * u / (2 * rise) : u - rise / 2;
}

/// Least squares of the displacements for one change point.
struct RampTrial {
  double start_s = 0, rise_s = 0, squares = 0;
  Eigen::Vector3d values;  ///< velocity before, its rise, slope after the rise
};

RampTrial ramp_trial(const ShiftSeries& s, const ChangeWindow& w, double start, double rise) {
  Eigen::Matrix3d xx = Eigen::Matrix3d::Zero();
  Eigen::Vector3d xy = Eigen::Vector3d::Zero();
  const auto row = [&](std::size_t k) {
    const double t0 = s.t0_s[k], t1 = s.t1_s[k];
    const double later0 = std::max(0.0, t0 - start - rise), later1 = std::max(0.0, t1 - start - rise);
    return Eigen::Vector3d(t1 - t0, ramp_integral(t1, start, rise) - ramp_integral(t0, start, rise),
                           (later1 * later1 - later0 * later0) / 2);
  };
  for (std::size_t k = w.begin; k < w.end; ++k) {
    const Eigen::Vector3d x = row(k);
    xx += x * x.transpose();
    xy += s.along[k] * x;
  }
  RampTrial t{start, rise, 0, xx.completeOrthogonalDecomposition().solve(xy)};
  for (std::size_t k = w.begin; k < w.end; ++k) {
    const double e = s.along[k] - row(k).dot(t.values);
    t.squares += e * e;
  }
  return t;
}

std::vector<RampTrial> ramp_trials(const ShiftSeries& s, const ChangeWindow& w, double earliest) {
  std::vector<RampTrial> trials;
  const double step = w.pair_s / kPerPair;
  std::vector<double> rises{0};
  double rise_s = w.pair_s / 2;
  while (rise_s < 2 * (w.half_s - earliest) + w.pair_s) {
    rises.push_back(rise_s);
    rise_s *= std::sqrt(2.0);
  }
  for (const double rise : rises)
    for (int i = 0; earliest + i * step <= w.half_s + w.pair_s / 2; ++i) {
      RampTrial t = ramp_trial(s, w, earliest + i * step, rise);
      if (t.values[1] > 0) trials.push_back(t);
    }
  return trials;
}

// Number of pairs per independent pair, from the correlation of neighbouring residuals.
double correlated_pairs(const ShiftSeries& s, const ChangeWindow& w, const RampTrial& best) {
  double product = 0, squares = 0, last = 0;
  for (std::size_t k = w.begin; k < w.end; ++k) {
    const double t0 = s.t0_s[k], t1 = s.t1_s[k];
    const double later0 = std::max(0.0, t0 - best.start_s - best.rise_s),
                 later1 = std::max(0.0, t1 - best.start_s - best.rise_s);
    const double e = s.along[k] - best.values[0] * (t1 - t0) -
                     best.values[1] * (ramp_integral(t1, best.start_s, best.rise_s) -
                                       ramp_integral(t0, best.start_s, best.rise_s)) -
                     best.values[2] * (later1 * later1 - later0 * later0) / 2;
    if (k > w.begin) product += e * last;
    squares += e * e;
    last = e;
  }
  const double rho = squares > 0 ? std::clamp(product / squares, 0.0, 0.95) : 0;
  return (1 + rho) / (1 - rho);
}

/// A possible time of the onset with its probability.
struct OnsetTime {
  double t_s, weight;
};

std::vector<OnsetTime> posterior_of(const ShiftSeries& s, const ChangeWindow& w,
                                    const std::vector<RampTrial>& trials, const RampTrial& best) {
  const double pairs = double(w.end - w.begin), rise = best.values[1] * w.pair_s;
  const double floor = pairs * std::pow(kModelError * rise, 2);
  const double exponent = pairs / correlated_pairs(s, w, best) / 2;
  std::vector<OnsetTime> posterior;
  double sum = 0;
  for (const RampTrial& t : trials) {
    const double weight = std::pow((best.squares + floor) / (t.squares + floor), exponent);
    posterior.push_back({t.start_s + kOnsetFraction * t.rise_s, weight});
    sum += weight;
  }
  for (OnsetTime& c : posterior) c.weight /= sum;
  std::sort(posterior.begin(), posterior.end(),
            [](const OnsetTime& a, const OnsetTime& b) { return a.t_s < b.t_s; });
  return posterior;
}

// `step`: of the grid of times; each of them stands for the half step on either side.
void summarise(const std::vector<OnsetTime>& posterior, double earliest, double step, ChangePoint& c) {
  double below = 0;
  for (const OnsetTime& p : posterior) {
    below += p.weight;
    c.t_s = p.t_s;
    if (below >= 0.5) break;
  }
  double inside = 0, shortest = 1e300;
  std::size_t from = 0;
  for (const OnsetTime& p : posterior) {
    inside += p.weight;
    while (inside - posterior[from].weight >= 0.9) inside -= posterior[from++].weight;
    if (inside < 0.9 || p.t_s - posterior[from].t_s >= shortest) continue;
    shortest = p.t_s - posterior[from].t_s;
    c.ci90 = {std::max(earliest, posterior[from].t_s - step / 2), p.t_s + step / 2};
  }
}

/// A standard error with its degrees of freedom.
struct StepError {
  double value = 0, degrees = 0;
};

// Of the difference of two means over the parts before and after the change: from means over blocks of the
// displacements across, whose expectation is zero, which includes slow fluctuations. The blocks are those of
// all pairs, as long as a sixth of the window.
StepError error_of_step(const ShiftSeries& s, const ChangeWindow& w, std::size_t after) {
  const std::size_t block = std::max<std::size_t>(1, (w.end - w.begin) / kWindowBlocks),
                    blocks = s.across.size() / block;
  double squares = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double mean = mean_of(s.across, b * block, (b + 1) * block);
    squares += mean * mean / double(blocks);
  }
  return {std::sqrt(squares * double(block) * (1 / double(w.change - w.begin) + 1 / double(w.end - after))),
          double(blocks)};
}

}  // namespace

double least_t(const ChangePoint& change, double searched_s, double others) {
  const double tests = others * std::max(1.0, searched_s / kIndependent);
  return student_t_quantile(1 - kFalseResponse / tests, change.degrees);
}

std::optional<ChangePoint> change_point(const ShiftSeries& s, double earliest, double latest) {
  const auto w = window_of(s, earliest, latest);
  if (!w) return {};
  const std::vector<RampTrial> trials = ramp_trials(s, *w, earliest);
  if (trials.empty()) return {};
  const RampTrial& best =
      *std::min_element(trials.begin(), trials.end(),
                        [](const RampTrial& a, const RampTrial& b) { return a.squares < b.squares; });
  ChangePoint c;
  summarise(posterior_of(s, *w, trials, best), earliest, w->pair_s / kPerPair, c);
  c.rise_s = best.rise_s;
  std::size_t after = w->change;
  while (after + kPairsBefore < w->end && s.t0_s[after] < w->half_s) ++after;
  c.before = mean_of(s.along, w->begin, w->change);
  c.after = mean_of(s.along, after, w->end);
  const StepError error = error_of_step(s, *w, after);
  c.degrees = error.degrees;
  c.t_statistic =
      error.value > 0 ? (c.after - c.before) / error.value : std::numeric_limits<double>::infinity();
  return c;
}

}  // namespace faba
