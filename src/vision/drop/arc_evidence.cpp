#include "vision/drop/arc_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/statistics.h"

namespace faba {
namespace {

constexpr double kExpected = 0.9;  // share of agreeing pieces on a true edge, for choosing the run
constexpr double kTolerances[] = {0.5, 1, 2, 3.5, 6};  // px; the best is chosen and paid for in the test
constexpr double kClear = -3;    // log10 of false alarms below which a tolerance may be chosen
constexpr double kSettled = -8;  // below it the first way of aligning the pieces is good enough
constexpr double kWays = 2;      // ways of aligning the pieces, both paid for

/// log10 of P(at least k successes in n trials of probability p).
double log10_tail(std::size_t n, std::size_t k, double p) {
  double sum = 0, largest = 0;
  std::vector<double> terms;
  for (std::size_t i = k; i <= n; ++i) {
    const double ni = double(n), ii = double(i);
    terms.push_back(std::lgamma(ni + 1) - std::lgamma(ii + 1) - std::lgamma(ni - ii + 1) + ii * std::log(p) +
                    (ni - ii) * std::log1p(-p));
  }
  largest = *std::max_element(terms.begin(), terms.end());
  for (double t : terms) sum += std::exp(t - largest);
  return (largest + std::log(sum)) / std::numbers::ln10;
}

/// A run of pieces [first, first + length), wrapping round a closed strip.
struct Run {
  std::size_t first = 0, length = 0, hits = 0;
};

/// The run with the best likelihood of "edge" against "chance".
Run best_run(const std::vector<bool>& hit, bool closed, double p) {
  const double gain = std::log(kExpected / p), loss = std::log((1 - kExpected) / (1 - p));
  Run best;
  double best_score = 0, score = 0;
  Run now;
  const std::size_t n = hit.size(), reach = closed ? 2 * n : n;
  for (std::size_t i = 0; i < reach; ++i) {
    if (score <= 0) {
      now = {i, 0, 0};
      score = 0;
    }
    if (now.length == n) break;
    score += hit[i % n] ? gain : loss;
    now.length += 1;
    now.hits += hit[i % n];
    if (score > best_score) {
      best_score = score;
      best = now;
    }
  }
  return best;
}

/// Root mean square of the profile's middle half without its line.
double relief(const std::vector<double>& profile, int half) {
  std::vector<double> middle(profile.begin() + half - half / 2, profile.begin() + half + half / 2 + 1);
  remove_line(middle);
  const double sum = std::inner_product(middle.begin(), middle.end(), middle.begin(), 0.0);
  return std::sqrt(sum / double(middle.size()));
}

/// The test at one tolerance.
struct Verdict {
  double tolerance = 0, log10_alarms = 1e9;
  Run run;
};

/// Probability that a piece agrees within a tolerance by chance.
double chance(const ArcStrip& strip, double tolerance) {
  const int reach = strip.half / 2;
  return 2 * tolerance / (2 * reach + 1);
}

std::vector<Verdict> judge(const ArcStrip& strip, double log10_circles) {
  std::vector<Verdict> verdicts;
  const double n = double(strip.pieces.size());
  // What was chosen among is paid for: circles told apart by a pixel, runs of pieces, tolerances, ways.
  const double tests = log10_circles + std::log10(n * n * kWays * double(std::size(kTolerances)));
  for (double tolerance : kTolerances) {
    std::vector<bool> hit;
    for (const ArcPiece& p : strip.pieces) hit.push_back(std::fabs(p.shift) <= tolerance);
    const double p = chance(strip, tolerance);
    Verdict v{tolerance, 1e9, best_run(hit, strip.closed, p)};
    if (v.run.hits >= 4) v.log10_alarms = log10_tail(v.run.length, v.run.hits, p) + tests;
    verdicts.push_back(v);
  }
  return verdicts;
}

/// The tightest tolerance that loses next to nothing of the arc the widest one shows, for the profile and the
/// support: an edge that is not quite a circle must not be taken for a better circle along a part of it.
struct Choice {
  Verdict tight, wide;
};

Choice choose(const std::vector<Verdict>& verdicts) {
  Choice c;
  c.tight = c.wide = *std::min_element(verdicts.begin(), verdicts.end(), [](const auto& a, const auto& b) {
    return a.log10_alarms < b.log10_alarms;
  });
  for (const Verdict& v : verdicts)
    if (v.log10_alarms < kClear && v.run.hits > c.wide.run.hits) c.wide = v;
  for (const Verdict& v : verdicts)
    if (v.log10_alarms < kClear && double(v.run.hits) >= 0.9 * double(c.wide.run.hits)) {
      c.tight = v;
      break;
    }
  return c;
}

/// The stretches in which a run agrees more than once in a hundred by chance. A corner of the picture that
/// the circle happens to cross must not be fitted along with a true arc elsewhere.
std::vector<bool> solid_stretches(const ArcStrip& strip, const Verdict& v) {
  const std::size_t count = strip.pieces.back().stretch + 1;
  std::vector<std::size_t> pieces(count), hits(count);
  for (std::size_t i = 0; i < v.run.length; ++i) {
    const ArcPiece& p = strip.pieces[(v.run.first + i) % strip.pieces.size()];
    pieces[p.stretch] += 1;
    hits[p.stretch] += std::fabs(p.shift) <= v.tolerance;
  }
  std::vector<bool> solid(count);
  for (std::size_t s = 0; s < count; ++s)
    solid[s] = hits[s] > 0 && log10_tail(pieces[s], hits[s], chance(strip, v.tolerance)) < -2;
  return solid;
}

/// Which pieces of a run see the same edge as their neighbours: within 3 robust sd of the median of five. Not
/// being on the circle is no reason to be left out.
std::vector<std::size_t> steady_pieces(const ArcStrip& strip, const Run& run) {
  const std::size_t n = strip.pieces.size(), length = run.length;
  auto shift = [&](std::size_t i) { return strip.pieces[(run.first + i) % n].shift; };
  std::vector<double> off(length), sizes;
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t from = std::min(i > 2 ? i - 2 : 0, length > 5 ? length - 5 : 0);
    std::vector<double> five;
    for (std::size_t k = from; k < std::min(from + 5, length); ++k) five.push_back(shift(k));
    off[i] = std::fabs(shift(i) - median_high(five));
    if (off[i] > 0) sizes.push_back(off[i]);
  }
  std::vector<std::size_t> steady;
  if (sizes.empty()) sizes.push_back(0);
  const double limit = std::max(3 * kMadToSd * median_high(sizes), 0.25);
  for (std::size_t i = 0; i < length; ++i)
    if (off[i] <= limit && 2 * std::fabs(shift(i)) < strip.half - strip.half % 2)
      steady.push_back((run.first + i) % n);
  return steady;
}

double fewest_alarms(const std::vector<Verdict>& verdicts) {
  double least = 1e9;
  for (const Verdict& v : verdicts) least = std::min(least, v.log10_alarms);
  return least;
}

/// Aligns the pieces by their common profile, or by their change of grey when that says clearly more.
std::vector<Verdict> align_and_judge(ArcStrip& strip, double log10_circles) {
  align_by_profile(strip);
  std::vector<Verdict> verdicts = judge(strip, log10_circles);
  if (fewest_alarms(verdicts) < kSettled) return verdicts;
  ArcStrip other = strip;
  align_by_change(other);
  std::vector<Verdict> others = judge(other, log10_circles);
  if (fewest_alarms(others) > fewest_alarms(verdicts) - 1) return verdicts;
  strip = std::move(other);
  return others;
}

}  // namespace

ArcEvidence weigh_arc(const GrayF& picture, const Circle& circle, const ArcStripOptions& options) {
  ArcEvidence e;
  ArcStrip strip = read_arc_strip(picture, circle, options);
  e.visible = strip.pieces.size();
  if (e.visible < 4) return e;
  const double w = picture.width, h = picture.height;
  const std::vector<Verdict> verdicts = align_and_judge(strip, std::log10(w * h * (w + h)));
  const auto [tight, wide] = choose(verdicts);
  e.log10_false_alarms = fewest_alarms(verdicts);
  e.tolerance_px = tight.tolerance;
  std::vector<double> mean(std::size_t(2 * strip.half + 1), 0.0);
  for (std::size_t i = 0; i < tight.run.length; ++i) {
    const ArcPiece& p = strip.pieces[(tight.run.first + i) % e.visible];
    if (std::fabs(p.shift) > tight.tolerance) continue;
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += p.grey[k] / double(tight.run.hits);
    for (double part : {-0.375, -0.125, 0.125, 0.375}) e.angles.push_back(p.angle + part * p.width);
  }
  const std::vector<bool> solid = solid_stretches(strip, wide);
  for (std::size_t k : steady_pieces(strip, wide.run)) {
    const ArcPiece& p = strip.pieces[k];
    if (!solid[p.stretch]) continue;
    const double r = circle.radius + p.shift;
    e.points.push_back({circle.centre.x + r * std::cos(p.angle), circle.centre.y + r * std::sin(p.angle)});
  }
  e.relief = relief(mean, strip.half);
  e.support = double(wide.run.hits) / double(e.visible);
  e.piece_px = strip.piece_px;
  e.length_px = double(wide.run.hits) * strip.piece_px;
  return e;
}

}  // namespace faba
