#include "vision/drop/arc_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/statistics.h"

namespace faba {
namespace {

constexpr double kExpected = 0.9;  // fraction of agreeing pieces on a true edge, for the choice of the run
constexpr double kTolerances[] = {0.5, 1, 2, 3.5,
                                  6};  // px; the choice of the best one is accounted for in the test
constexpr double kSelectable = -3;     // log10 of false alarms below which a tolerance can be chosen
constexpr double kSufficient =
    -8;  // log10 of false alarms below which the first alignment method is sufficient
constexpr double kAlignments = 2;  // number of alignment methods, accounted for in the test

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

/// A run of pieces [first, first + length), cyclic on a closed strip.
struct Run {
  std::size_t first = 0, length = 0, hits = 0;
};

/// The run with the maximum likelihood ratio of "edge" against "noise".
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

/// Rms about the linear fit of the middle half of the profile.
double relief(const std::vector<double>& profile, int half) {
  std::vector<double> middle(profile.begin() + half - half / 2, profile.begin() + half + half / 2 + 1);
  remove_line(middle);
  const double sum = std::inner_product(middle.begin(), middle.end(), middle.begin(), 0.0);
  return std::sqrt(sum / double(middle.size()));
}

/// The test at one tolerance.
struct ToleranceTest {
  double tolerance = 0, log10_alarms = 1e9;
  Run run;
};

/// Probability that a random piece agrees within a tolerance.
double random_agreement(const ArcStrip& strip, double tolerance) {
  const int reach = strip.half / 2;
  return 2 * tolerance / (2 * reach + 1);
}

std::vector<ToleranceTest> test_tolerances(const ArcStrip& strip, double log10_circles) {
  std::vector<ToleranceTest> tests_by_tolerance;
  const double n = double(strip.pieces.size());
  // Number of tests: circles that differ by a pixel, runs of pieces, tolerances, alignment methods.
  const double tests = log10_circles + std::log10(n * n * kAlignments * double(std::size(kTolerances)));
  for (double tolerance : kTolerances) {
    std::vector<bool> hit;
    for (const ArcPiece& p : strip.pieces) hit.push_back(std::fabs(p.shift) <= tolerance);
    const double p = random_agreement(strip, tolerance);
    ToleranceTest v{tolerance, 1e9, best_run(hit, strip.closed, p)};
    if (v.run.hits >= 4) v.log10_alarms = log10_tail(v.run.length, v.run.hits, p) + tests;
    tests_by_tolerance.push_back(v);
  }
  return tests_by_tolerance;
}

/// `wide` has the longest arc; `tight` is the smallest tolerance with at least 90 % of that arc. The support
/// is measured with `wide`, so that an edge that is not exactly a circle is not mistaken for a better circle
/// along a part of it.
struct Choice {
  ToleranceTest tight, wide;
};

Choice choose(const std::vector<ToleranceTest>& tests_by_tolerance) {
  Choice c;
  c.tight = c.wide =
      *std::min_element(tests_by_tolerance.begin(), tests_by_tolerance.end(),
                        [](const auto& a, const auto& b) { return a.log10_alarms < b.log10_alarms; });
  for (const ToleranceTest& v : tests_by_tolerance)
    if (v.log10_alarms < kSelectable && v.run.hits > c.wide.run.hits) c.wide = v;
  for (const ToleranceTest& v : tests_by_tolerance)
    if (v.log10_alarms < kSelectable && double(v.run.hits) >= 0.9 * double(c.wide.run.hits)) {
      c.tight = v;
      break;
    }
  return c;
}

/// The segments in which the run is significant at the 1 % level. A picture corner that the circle happens to
/// cross must not be included in the fit.
std::vector<bool> significant_segments(const ArcStrip& strip, const ToleranceTest& v) {
  const std::size_t count = strip.pieces.back().segment + 1;
  std::vector<std::size_t> pieces(count), hits(count);
  for (std::size_t i = 0; i < v.run.length; ++i) {
    const ArcPiece& p = strip.pieces[(v.run.first + i) % strip.pieces.size()];
    pieces[p.segment] += 1;
    hits[p.segment] += std::fabs(p.shift) <= v.tolerance;
  }
  std::vector<bool> significant(count);
  for (std::size_t s = 0; s < count; ++s)
    significant[s] = hits[s] > 0 && log10_tail(pieces[s], hits[s], random_agreement(strip, v.tolerance)) < -2;
  return significant;
}

/// Pieces of a run that are consistent with their neighbours: shift within 3 robust sd of the median of five.
/// Distance from the circle is not a criterion.
std::vector<std::size_t> consistent_pieces(const ArcStrip& strip, const Run& run) {
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
  std::vector<std::size_t> consistent;
  if (sizes.empty()) sizes.push_back(0);
  const double limit = std::max(3 * kMadToSd * median_high(sizes), 0.25);
  for (std::size_t i = 0; i < length; ++i)
    if (off[i] <= limit && 2 * std::fabs(shift(i)) < strip.half - strip.half % 2)
      consistent.push_back((run.first + i) % n);
  return consistent;
}

double min_log10_alarms(const std::vector<ToleranceTest>& tests_by_tolerance) {
  double lowest = 1e9;
  for (const ToleranceTest& v : tests_by_tolerance) lowest = std::min(lowest, v.log10_alarms);
  return lowest;
}

/// Aligns the pieces by their common profile, or by their change of grey when that is clearly more
/// significant.
std::vector<ToleranceTest> align_and_test(ArcStrip& strip, double log10_circles) {
  align_by_profile(strip);
  std::vector<ToleranceTest> tests_by_tolerance = test_tolerances(strip, log10_circles);
  if (min_log10_alarms(tests_by_tolerance) < kSufficient) return tests_by_tolerance;
  ArcStrip other = strip;
  align_by_change(other);
  std::vector<ToleranceTest> other_tests = test_tolerances(other, log10_circles);
  if (min_log10_alarms(other_tests) > min_log10_alarms(tests_by_tolerance) - 1) return tests_by_tolerance;
  strip = std::move(other);
  return other_tests;
}

}  // namespace

ArcEvidence evaluate_arc(const GrayF& picture, const Circle& circle, const ArcStripOptions& options) {
  ArcEvidence e;
  ArcStrip strip = read_arc_strip(picture, circle, options);
  e.visible = strip.pieces.size();
  if (e.visible < 4) return e;
  const double w = picture.width, h = picture.height;
  const std::vector<ToleranceTest> tests_by_tolerance = align_and_test(strip, std::log10(w * h * (w + h)));
  const auto [tight, wide] = choose(tests_by_tolerance);
  e.log10_false_alarms = min_log10_alarms(tests_by_tolerance);
  e.tolerance_px = tight.tolerance;
  std::vector<double> mean(std::size_t(2 * strip.half + 1), 0.0);
  for (std::size_t i = 0; i < tight.run.length; ++i) {
    const ArcPiece& p = strip.pieces[(tight.run.first + i) % e.visible];
    if (std::fabs(p.shift) > tight.tolerance) continue;
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += p.grey[k] / double(tight.run.hits);
    for (double part : {-0.375, -0.125, 0.125, 0.375}) e.angles.push_back(p.angle + part * p.width);
  }
  const std::vector<bool> significant = significant_segments(strip, wide);
  for (std::size_t k : consistent_pieces(strip, wide.run)) {
    const ArcPiece& p = strip.pieces[k];
    if (!significant[p.segment]) continue;
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
