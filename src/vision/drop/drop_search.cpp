#include "vision/drop/drop_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/units.h"

namespace faba {
namespace {

constexpr int kProfile = 16;                // px of the level, half width of the profile
constexpr double kStraight = 1e5;           // px: an arc of 1000 px with this radius has a sagitta of 1.25 px
constexpr double kMaxNonCircularity = 0.1;  // a third of the value of a corner
constexpr double kMinDeviationPx =
    0.5;                               // px, deviation of a short arc at the picture border that is tolerated
constexpr double kCornerDeg = 120;     // a longer arc cannot be confused with two straight lines
constexpr double kMaxLog10Alarms = 5;  // log10 of false alarms above which a circle is discarded

constexpr const char* kChance =
    "no drop edge detected: no circle fits the edges in the picture better than random clutter (cells, "
    "noise); show more of the drop edge, or focus on it";
constexpr const char* kContours =
    "no drop edge detected: the arcs are quantisation contours in uneven light; use more contrast or more "
    "bits per pixel";

/// Whether a covers a longer edge than b or, for similar lengths, is more significant.
bool better(const DropCandidate& a, const DropCandidate& b) {
  const double length_a = a.evidence.length_px * a.scale, length_b = b.evidence.length_px * b.scale;
  if (length_a > 1.1 * length_b) return true;
  if (length_b > 1.1 * length_a) return false;
  return a.evidence.log10_false_alarms < b.evidence.log10_false_alarms;
}

/// Variance inflation of the fit by correlated residuals: 1 + 2 sum of the autocorrelations along
/// the arc, up to the first that is not significant.
double correlation_factor(const std::vector<Vec2>& points, const CircleFit& fit) {
  std::vector<double> r;
  r.reserve(points.size());
  for (Vec2 p : points) r.push_back(norm(p - fit.centre) - fit.radius);
  double power = 0, factor = 1;
  for (double x : r) power += x * x;
  for (std::size_t lag = 1; lag < r.size() / 2 && power > 0; ++lag) {
    double sum = 0;
    for (std::size_t i = lag; i < r.size(); ++i) sum += r[i] * r[i - lag];
    if (sum < 2 / std::sqrt(double(r.size())) * power) break;
    factor += 2 * sum / power;
  }
  return factor;
}

/// Residuals of a fit along its arc, as Legendre polynomials of the arc angle. A circle absorbs the first
/// three; the next four are the slowest deviations that remain.
struct SlowDeviations {
  static constexpr std::size_t kFirst = 3, kModes = 4;
  std::array<double, kModes> sum{}, weight{};  ///< residuals times polynomial, square of the polynomial
  double power = 0;                            ///< sum of the squared residuals
  double points = 0;

  SlowDeviations(const std::vector<Vec2>& at, const CircleFit& fit, double half_rad)
      : points(double(at.size())) {
    const Vec2 middle = at[at.size() / 2] - fit.centre;
    const double axis = std::atan2(middle.y, middle.x);
    for (Vec2 p : at) {
      const Vec2 r = p - fit.centre;
      const double off = norm(r) - fit.radius;
      const double u =
          std::clamp(std::remainder(std::atan2(r.y, r.x) - axis, 2 * std::numbers::pi) / half_rad, -1.0, 1.0);
      power += off * off;
      double before = 1, now = u;
      for (std::size_t k = 1; k < kFirst + kModes; ++k) {
        if (k >= kFirst) {
          sum[k - kFirst] += off * now;
          weight[k - kFirst] += now * now;
        }
        const double next = (double(2 * k + 1) * u * now - double(k) * before) / double(k + 1);
        before = now;
        now = next;
      }
    }
  }
  double amplitude(std::size_t k) const { return sum[k] / weight[k]; }
  /// Mean power of the modes over that of independent residuals. The errors of the circle are due to the
  /// three modes that it absorbs, whose power is that of these neighbours if errors of the edge position
  /// change slowly along it.
  double variance_factor() const {
    double modes = 0;
    for (std::size_t k = 0; k < kModes; ++k) modes += sum[k] * sum[k] / weight[k] / double(kModes);
    return power > 0 ? modes * points / power : 1;
  }
};

/// Deviation of the edge from a circular arc: the components of the residuals along the third and
/// fourth Legendre polynomial of the arc angle, relative to the sagitta. A corner between two straight lines
/// gives 0.3, an arc 0. Zero when it is below 3 standard errors or half a pixel.
double non_circularity(const DropCandidate& d) {
  if (d.points.size() < 8) return 0;
  const double half = d.arc_rad / 2;
  const SlowDeviations s(d.points, d.fit, half);
  const double c3 = s.amplitude(0), c4 = s.amplitude(1), size = std::sqrt(c3 * c3 + c4 * c4);
  const double rest = std::max(s.power - c3 * s.sum[0] - c4 * s.sum[1], 0.0) / double(d.points.size());
  const double error = std::sqrt(rest * (1 / s.weight[0] + 1 / s.weight[1]));
  return size > std::max(3 * error, kMinDeviationPx) ? size / (d.fit.radius * half * half / 3) : 0;
}

/// Half the difference of the axes of an ellipse along the edge: amplitude of the residuals' second harmonic
/// of the angle. Zero when it is below 3 standard errors, and for less than half a circle, where it cannot be
/// distinguished.
double out_of_round(const DropCandidate& d) {
  if (d.arc_rad < std::numbers::pi || d.points.size() < 8) return 0;
  double cc = 0, ss = 0, cs = 0, co = 0, so = 0, power = 0;
  for (Vec2 p : d.points) {
    const Vec2 r = p - d.fit.centre;
    const double angle = 2 * std::atan2(r.y, r.x), off = norm(r) - d.fit.radius;
    const double c = std::cos(angle), s = std::sin(angle);
    cc += c * c;
    ss += s * s;
    cs += c * s;
    co += c * off;
    so += s * off;
    power += off * off;
  }
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 0)) return 0;
  const double a = (ss * co - cs * so) / determinant, b = (cc * so - cs * co) / determinant;
  const double rest = std::max(power - a * co - b * so, 0.0) / double(d.points.size());
  const double error = std::sqrt(rest * (cc + ss) / determinant);
  const double amplitude = std::hypot(a, b);
  return amplitude > 3 * error ? amplitude : 0;
}

/// Sum of the angles between neighbouring points, without gaps of more than five pieces.
double seen_angle(const std::vector<Vec2>& points, Vec2 centre, double piece_rad) {
  std::vector<double> angle;
  angle.reserve(points.size());
  for (Vec2 p : points) angle.push_back(std::atan2(p.y - centre.y, p.x - centre.x));
  std::sort(angle.begin(), angle.end());
  angle.push_back(angle.front() + 2 * std::numbers::pi);
  double sum = 0;
  for (std::size_t i = 1; i < angle.size(); ++i) {
    const double gap = angle[i] - angle[i - 1];
    sum += gap <= 5 * piece_rad ? gap : piece_rad;
  }
  return sum;
}

std::string describe_straight_or_short(const DropCandidate& d, const DropEdgeOptions& o) {
  const double length = d.circle.radius * d.arc_rad, sagitta = length * d.arc_rad / 8;
  const double sd_sagitta = sagitta * d.fit.sd_radius / d.circle.radius;
  if (sagitta < 4 * sd_sagitta || sagitta < 1)
    return fmt::format(
        "the detected edge is too straight for a circle (it bends by {:.1f} +- {:.1f} px over a length of "
        "{:.0f} px); use a picture that shows a longer arc of the drop edge",
        sagitta, sd_sagitta, length);
  return fmt::format(
      "no drop edge detected: the best arc covers only {:.1f} degrees of a circle of radius {:.0f} px (at "
      "least {:.0f} degrees required); use a lower magnification or show more of the edge",
      d.seen_rad * kDegreesPerRadian, d.circle.radius, o.min_arc_deg);
}

/// Reason for rejecting a circle; empty: accepted.
std::string rejection(const DropCandidate& d, const DropPicture& picture, const DropEdgeOptions& o) {
  const double radius = d.circle.radius, sd = d.fit.sd_radius;
  if (d.evidence.log10_false_alarms > o.max_log10_false_alarms) return kChance;
  if (d.seen_rad * kDegreesPerRadian < o.min_arc_deg) return describe_straight_or_short(d, o);
  if (d.arc_rad * kDegreesPerRadian < kCornerDeg && non_circularity(d) > kMaxNonCircularity)
    return fmt::format(
        "no drop edge detected: the longest edge has a corner, it is not round (best radius {:.0f} px); show "
        "the round edge of the drop",
        radius);
  if (d.evidence.support < o.min_support)
    return fmt::format(
        "no drop edge detected: the best circle (radius {:.0f} px) follows an edge along only "
        "{:.0f} % of its visible arc (at least {:.0f} % required); show more of the drop edge, or focus on "
        "it",
        radius, 100 * d.evidence.support, 100 * o.min_support);
  if (sd > o.max_relative_sd * radius)
    return fmt::format(
        "the radius {:.0f} +- {:.0f} px is too uncertain (maximum {:.0f} %); show more of the drop edge, or "
        "focus on it",
        radius, sd, 100 * o.max_relative_sd);
  // Rms about the linear fit: h/4 for a step of height h, 0.29 h for a saw-tooth of contours of height h.
  if (d.evidence.relief < 0.25 * o.min_contrast_steps * picture.contours) return kContours;
  return {};
}

/// Maximum distance between two circles at the given points.
double distance(const Circle& a, const Circle& b, const std::vector<Vec2>& at) {
  double most = 0;
  for (Vec2 p : at)
    most = std::max(most, std::fabs(norm(p - a.centre) - a.radius - norm(p - b.centre) + b.radius));
  return most;
}

/// One refinement: evidence of the pyramid level near `start`, and the circle fitted to it.
std::optional<DropCandidate> refine_once(const DropLevel& level, const Circle& start) {
  DropCandidate d;
  d.scale = level.scale;
  d.evidence = evaluate_arc(level.flat, level.to_level(start));
  if (d.evidence.points.size() < 6 || d.evidence.log10_false_alarms > kMaxLog10Alarms) return std::nullopt;
  for (Vec2 p : d.evidence.points) d.points.push_back(level.to_picture(p));
  try {
    d.fit = refine_circle(d.points, start, CircleLoss::square);
  } catch (const Error&) {
    // The points are collinear within double precision; the uncertainty of the radius equals the radius.
    if (start.radius < kStraight) return std::nullopt;
    d.fit.centre = start.centre;
    d.fit.radius = d.fit.sd_radius = start.radius;
    d.fit.arc_rad = covered_angle(d.points, start.centre);
  }
  const Circle fitted = level.to_level({d.fit.centre, d.fit.radius});
  // Shading subtraction distorts the profile of an edge with a halo; in coarse levels the shading itself is
  // stronger.
  const GrayF& grey = level.scale > 2 ? level.flat : level.grey;
  d.profile = fit_edge_profile(mean_profile(grey, fitted, d.evidence.angles, kProfile));
  d.circle = {d.fit.centre, d.fit.radius + d.profile.position * level.scale};
  if (!(d.circle.radius > 0)) return std::nullopt;
  const double piece_rad = d.evidence.piece_px * level.scale / d.circle.radius;
  d.arc_rad = std::min(2 * std::numbers::pi, d.fit.arc_rad + piece_rad);
  d.seen_rad = std::min(d.arc_rad, seen_angle(d.points, d.circle.centre, piece_rad));
  const double inflate = std::sqrt(std::max(
      correlation_factor(d.points, d.fit), SlowDeviations(d.points, d.fit, d.arc_rad / 2).variance_factor()));
  d.fit.sd_centre = inflate * d.fit.sd_centre;
  d.fit.sd_radius *= inflate;
  d.out_of_round_px = out_of_round(d);
  return d;
}

/// Iteratively refines a circle to the nearby edge in a pyramid level. Empty when it does not converge to a
/// sharp edge.
std::optional<DropCandidate> refine_to_edge(const DropLevel& level, Circle circle) {
  std::optional<DropCandidate> best;
  for (int round = 0; round < 6; ++round) {
    auto now = refine_once(level, circle);
    if (!now) break;
    const double moved = distance(now->circle, circle, now->points) / level.scale;
    circle = now->circle;
    // Wider than 5 px of this level, or neither step nor line: shading, or an edge for a coarser level.
    const bool sharp = now->profile.width < 5 && now->profile.explained > 0.5;
    // Converged: the change is below half a pixel or below the jitter from the scatter of the pieces.
    const double jitter = 5 * now->fit.rms / level.scale / std::sqrt(double(now->points.size()));
    if (moved < std::max(0.5, jitter) && sharp && (!best || better(*now, *best))) best = std::move(now);
    if (moved < std::max(0.05, 0.2 * jitter)) break;
  }
  return best;
}

class Search {
 public:
  Search(const DropPicture& picture, const DropEdgeOptions& o) : picture_(picture), options_(o) {}

  /// Refines the circles found among the edge pixels of pyramid level k, in this level and in every finer
  /// one.
  void try_pixels(const std::vector<EdgePixel>& pixels, const std::vector<EdgeSegment>& segments,
                  std::size_t k) {
    std::vector<Vec2> positions, normals;
    for (const EdgePixel& p : pixels) {
      positions.push_back(p.pos);
      normals.push_back(p.normal);
    }
    const DropLevel& level = picture_.levels[k];
    CircleSearchOptions o;
    o.trials = options_.trials;
    o.seed = options_.seed;
    o.max_circles = 4;
    o.min_radius = options_.min_radius_fraction * std::min(level.grey.width, level.grey.height);
    o.max_radius =
        1000.0 * (level.grey.width + level.grey.height);  // larger radii are indistinguishable from a line
    for (const Circle& c : search_circles(positions, normals, o))
      try_circle(level.to_picture(c), segments, k);
  }

  void try_circle(Circle circle, const std::vector<EdgeSegment>& segments, std::size_t k) {
    if (already_refined(circle, picture_.levels[k].scale)) return;
    for (std::size_t j = k + 1; j-- > 0;) {
      auto d = refine_to_edge(picture_.levels[j], circle);
      if (!d) break;
      circle = d->circle;
      d->rejection = rejection(*d, picture_, options_);
      const bool significant = is_significant(*d);
      if (significant) refined_.push_back(*d);
      if (d->rejection.empty()) {
        if (!found.accepted || better(*d, *found.accepted)) {
          keep_segments(segments, picture_.levels[k], d->circle);
          found.accepted = std::move(d);
        }
      } else if (!found.rejected ||
                 (significant == is_significant(*found.rejected) ? better(*d, *found.rejected)
                                                                 : significant)) {
        found.rejected = std::move(d);
      }
      if (!significant) break;
    }
  }

  bool is_conclusive() const {
    return found.accepted && found.accepted->evidence.support > 0.9 &&
           found.accepted->evidence.log10_false_alarms < -10;
  }

  DropSearch found;

 private:
  bool is_significant(const DropCandidate& d) const {
    return d.evidence.log10_false_alarms < options_.max_log10_false_alarms;
  }
  /// Whether a refined circle already runs along this one: the result would be the same.
  bool already_refined(const Circle& circle, double scale) const {
    return std::any_of(refined_.begin(), refined_.end(), [&](const DropCandidate& d) {
      return distance(circle, d.circle, d.points) < 6 * std::max(scale, d.scale);
    });
  }
  /// Keeps the segments along the circle; chords that deviate from it belong to other edges.
  void keep_segments(const std::vector<EdgeSegment>& segments, const DropLevel& level, const Circle& circle) {
    found.segments.clear();
    const double slack = 3 + 2 * level.scale;
    for (const EdgeSegment& s : segments) {
      const EdgeSegment here{level.to_picture(s.a), level.to_picture(s.b)};
      auto off = [&](Vec2 p) { return std::fabs(norm(p - circle.centre) - circle.radius); };
      if (off(here.a) < slack && off(here.b) < slack && off(0.5 * (here.a + here.b)) < slack)
        found.segments.push_back(here);
    }
  }

  const DropPicture& picture_;
  const DropEdgeOptions& options_;
  std::vector<DropCandidate> refined_;
};

EdgeSegments segments_of(const DropLevel& level, const DropEdgeOptions& o) {
  EdgeSegmentOptions edges = o.edges;
  if (level.scale > 1 && edges.threshold != EdgeThreshold::otsu) edges.threshold = EdgeThreshold::noise;
  // Lengths are in px of the picture; segments of a few px in a coarse level are indistinguishable from
  // noise.
  edges.min_length_px = std::max(10.0, edges.min_length_px / level.scale);
  edges.fill_gap_px = std::max(4.0, edges.fill_gap_px / level.scale);
  return find_edge_segments(level.flat, edges);
}

/// A circle through a segment that is so large that it is straight across any picture.
Circle straight_circle(const EdgeSegment& s) {
  const Vec2 d = s.b - s.a, middle = 0.5 * (s.a + s.b);
  const Vec2 normal = (1 / norm(d)) * Vec2{-d.y, d.x};
  return {middle + 100 * kStraight * normal, 100 * kStraight};
}

}  // namespace

DropSearch search_drop_edge(const DropPicture& picture, const DropEdgeOptions& options) {
  Search search(picture, options);
  std::vector<EdgeSegments> edges;
  for (std::size_t k = 0; k < picture.levels.size() && !search.is_conclusive(); ++k) {
    edges.push_back(segments_of(picture.levels[k], options));
    search.try_pixels(edges[k].support, edges[k].segments, k);
  }
  for (std::size_t k = 0; k < edges.size() && !search.found.accepted; ++k)
    search.try_pixels(edges[k].pixels, edges[k].segments, k);
  for (std::size_t k = 0; k < edges.size() && !search.found.accepted; ++k)
    for (std::size_t i = 0; i < std::min<std::size_t>(2, edges[k].segments.size()); ++i)
      search.try_circle(picture.levels[k].to_picture(straight_circle(edges[k].segments[i])),
                        edges[k].segments, k);
  return std::move(search.found);
}

}  // namespace faba
