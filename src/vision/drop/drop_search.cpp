#include "vision/drop/drop_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace faba {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kProfile = 16;        // px of the copy each side of the circle
constexpr double kStraight = 1e5;   // px: 1000 px of an arc of this radius bend by 1.25 px
constexpr double kCrooked = 0.1;    // a third of what a corner gives
constexpr double kCrookedPx = 0.5;  // what the border of a picture can do to a short arc in its corner
constexpr double kCornerDeg = 120;  // two straight lines cannot pass for a longer arc
constexpr double kHopeful = 5;      // log10 of false alarms: above, a circle is not worth following

constexpr const char* kChance =
    "no edge of a drop: no circle follows the edges in the picture better than scattered cells or noise; "
    "show more of the drop's edge, or focus on it";
constexpr const char* kContours =
    "no edge of a drop: the arcs in the picture are single steps of its grey scale in uneven light; "
    "use more contrast or more bits per pixel";

/// Whether a shows more of an edge than b, or as much and more certainly.
bool better(const DropCandidate& a, const DropCandidate& b) {
  const double length_a = a.evidence.length_px * a.scale, length_b = b.evidence.length_px * b.scale;
  if (length_a > 1.1 * length_b) return true;
  if (length_b > 1.1 * length_a) return false;
  return a.evidence.log10_false_alarms < b.evidence.log10_false_alarms;
}

/// How much larger the variance of a fit is than if neighbouring pieces were independent: 1 + 2 sum of the
/// correlations of the residuals along the arc, up to the first that is not significant.
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

/// How far the edge is from being one arc: the part of its residuals that bends more than a circle can (third
/// and fourth Legendre polynomial along the arc), relative to the bend of the arc itself. A corner between
/// two straight lines gives 0.3, an arc 0. Zero when it is within 3 standard errors or half a pixel.
double crookedness(const DropCandidate& d) {
  if (d.points.size() < 8) return 0;
  const Vec2 middle = d.points[d.points.size() / 2] - d.fit.centre;
  const double axis = std::atan2(middle.y, middle.x), half = d.arc_rad / 2;
  double sum3 = 0, sum4 = 0, norm3 = 0, norm4 = 0, power = 0;
  for (Vec2 p : d.points) {
    const Vec2 r = p - d.fit.centre;
    const double u =
        std::clamp(std::remainder(std::atan2(r.y, r.x) - axis, 2 * std::numbers::pi) / half, -1.0, 1.0);
    const double u2 = u * u, p3 = u * (5 * u2 - 3) / 2, p4 = (u2 * (35 * u2 - 30) + 3) / 8,
                 off = norm(r) - d.fit.radius;
    sum3 += off * p3;
    norm3 += p3 * p3;
    sum4 += off * p4;
    norm4 += p4 * p4;
    power += off * off;
  }
  const double c3 = sum3 / norm3, c4 = sum4 / norm4, size = std::sqrt(c3 * c3 + c4 * c4);
  const double rest = std::max(power - c3 * sum3 - c4 * sum4, 0.0) / double(d.points.size());
  const double error = std::sqrt(rest * (1 / norm3 + 1 / norm4));
  return size > std::max(3 * error, kCrookedPx) ? size / (d.fit.radius * half * half / 3) : 0;
}

/// The sum of the angles between neighbouring points, without gaps of more than five pieces.
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

std::string straight_or_short(const DropCandidate& d, const DropEdgeOptions& o) {
  const double length = d.circle.radius * d.arc_rad, bend = length * d.arc_rad / 8;
  const double sd_bend = bend * d.fit.sd_radius / d.circle.radius;
  if (bend < 4 * sd_bend || bend < 1)
    return fmt::format(
        "the edge is a straight line: it bends by {:.1f} +- {:.1f} px over {:.0f} px; "
        "show the round edge of the drop",
        bend, sd_bend, length);
  return fmt::format(
      "the edge covers only {:.1f} degrees of a circle of radius {:.0f} px ({:.0f} degrees needed); "
      "use a lower magnification or show more of the edge",
      d.seen_rad * kDegrees, d.circle.radius, o.min_arc_deg);
}

/// Why a circle is not accepted; empty when it is.
std::string objection(const DropCandidate& d, const DropPicture& picture, const DropEdgeOptions& o) {
  const double radius = d.circle.radius, sd = d.fit.sd_radius;
  if (d.evidence.log10_false_alarms > o.max_log10_false_alarms) return kChance;
  if (d.seen_rad * kDegrees < o.min_arc_deg) return straight_or_short(d, o);
  if (d.arc_rad * kDegrees < kCornerDeg && crookedness(d) > kCrooked)
    return fmt::format(
        "no edge of a drop: the longest edge is bent at a corner, not round (best radius {:.0f} px); "
        "show the round edge of the drop",
        radius);
  if (d.evidence.support < o.min_support)
    return fmt::format(
        "no edge of a drop: the best circle (radius {:.0f} px) follows an edge along only {:.0f} % "
        "of its arc in the picture; show more of the drop's edge, or focus on it",
        radius, 100 * d.evidence.support);
  if (sd > o.max_sd_share * radius)
    return fmt::format(
        "the radius is too unsure ({:.0f} +- {:.0f} px); "
        "show more of the drop's edge, or focus on it",
        radius, sd);
  // A step of height h leaves h/4 about the best straight line; a saw-tooth of contour lines 0.29 of theirs.
  if (d.evidence.relief < 0.25 * o.min_contrast_steps * picture.contours) return kContours;
  return {};
}

/// Largest distance between two circles at the points given.
double distance(const Circle& a, const Circle& b, const std::vector<Vec2>& at) {
  double most = 0;
  for (Vec2 p : at)
    most = std::max(most, std::fabs(norm(p - a.centre) - a.radius - norm(p - b.centre) + b.radius));
  return most;
}

/// One round of following: what the copy shows near `start`, and the circle fitted to that.
std::optional<DropCandidate> step_towards(const DropLevel& level, const Circle& start) {
  DropCandidate d;
  d.scale = level.scale;
  d.evidence = weigh_arc(level.flat, level.to_level(start));
  if (d.evidence.points.size() < 6 || d.evidence.log10_false_alarms > kHopeful) return std::nullopt;
  for (Vec2 p : d.evidence.points) d.points.push_back(level.to_picture(p));
  try {
    d.fit = refine_circle(d.points, start, CircleLoss::square);
  } catch (const Error&) {
    // The points lie on a line as far as numbers of 53 bits can tell; the radius is as unsure as it is large.
    if (start.radius < kStraight) return std::nullopt;
    d.fit.centre = start.centre;
    d.fit.radius = d.fit.sd_radius = start.radius;
    d.fit.arc_rad = covered_angle(d.points, start.centre);
  }
  const Circle fitted = level.to_level({d.fit.centre, d.fit.radius});
  // Taking the shading off bends the profile of an edge with a halo; in a coarse copy the light itself is
  // bent more.
  const GrayF& grey = level.scale > 2 ? level.flat : level.grey;
  d.profile = fit_edge_profile(mean_profile(grey, fitted, d.evidence.angles, kProfile));
  d.circle = {d.fit.centre, d.fit.radius + d.profile.position * level.scale};
  if (!(d.circle.radius > 0)) return std::nullopt;
  const double inflate = std::sqrt(correlation_factor(d.points, d.fit));
  d.fit.sd_centre = inflate * d.fit.sd_centre;
  d.fit.sd_radius *= inflate;
  const double piece_rad = d.evidence.piece_px * level.scale / d.circle.radius;
  d.arc_rad = std::min(2 * std::numbers::pi, d.fit.arc_rad + piece_rad);
  d.seen_rad = std::min(d.arc_rad, seen_angle(d.points, d.circle.centre, piece_rad));
  return d;
}

/// Moves a circle to the edge that the copy shows nearby. Nothing when it does not come to rest on a sharp
/// edge.
std::optional<DropCandidate> follow(const DropLevel& level, Circle circle) {
  std::optional<DropCandidate> best;
  for (int round = 0; round < 6; ++round) {
    auto now = step_towards(level, circle);
    if (!now) break;
    const double moved = distance(now->circle, circle, now->points) / level.scale;
    circle = now->circle;
    // Wider than 5 px of this copy, or no step or line at all: shading, or for a coarser copy.
    const bool sharp = now->profile.width < 5 && now->profile.explained > 0.5;
    // At rest: it moves by less than half a pixel, or than the scatter of its pieces lets it jitter.
    const double jitter = 5 * now->fit.rms / level.scale / std::sqrt(double(now->points.size()));
    if (moved < std::max(0.5, jitter) && sharp && (!best || better(*now, *best))) best = std::move(now);
    if (moved < std::max(0.05, 0.2 * jitter)) break;
  }
  return best;
}

class Search {
 public:
  Search(const DropPicture& picture, const DropEdgeOptions& o) : picture_(picture), options_(o) {}

  /// Follows the circles found among the pixels of copy k, there and in every finer copy.
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
    o.min_radius = options_.min_radius_share * std::min(level.grey.width, level.grey.height);
    o.max_radius = 1000.0 * (level.grey.width + level.grey.height);  // a line of pixels is no rounder
    for (const Circle& c : search_circles(positions, normals, o))
      try_circle(level.to_picture(c), segments, k);
  }

  void try_circle(Circle circle, const std::vector<EdgeSegment>& segments, std::size_t k) {
    if (known(circle, picture_.levels[k].scale)) return;
    for (std::size_t j = k + 1; j-- > 0;) {
      auto d = follow(picture_.levels[j], circle);
      if (!d) break;
      circle = d->circle;
      d->objection = objection(*d, picture_, options_);
      const bool sure = is_sure(*d);
      if (sure) seen_.push_back(*d);
      if (d->objection.empty()) {
        if (!found.accepted || better(*d, *found.accepted)) {
          keep_segments(segments, picture_.levels[k], d->circle);
          found.accepted = std::move(d);
        }
      } else if (!found.refused || (sure == is_sure(*found.refused) ? better(*d, *found.refused) : sure)) {
        found.refused = std::move(d);
      }
      if (!sure) break;
    }
  }

  bool convinced() const {
    return found.accepted && found.accepted->evidence.support > 0.9 &&
           found.accepted->evidence.log10_false_alarms < -10;
  }

  DropSearch found;

 private:
  bool is_sure(const DropCandidate& d) const {
    return d.evidence.log10_false_alarms < options_.max_log10_false_alarms;
  }
  /// Whether the circle runs along one that was followed before: it would only end there again.
  bool known(const Circle& circle, double scale) const {
    return std::any_of(seen_.begin(), seen_.end(), [&](const DropCandidate& d) {
      return distance(circle, d.circle, d.points) < 6 * std::max(scale, d.scale);
    });
  }
  /// Those that run along the circle; longer chords belong to something else.
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
  std::vector<DropCandidate> seen_;
};

EdgeSegments segments_of(const DropLevel& level, const DropEdgeOptions& o) {
  EdgeSegmentOptions edges = o.edges;
  if (level.scale > 1 && edges.threshold != EdgeThreshold::otsu) edges.threshold = EdgeThreshold::noise;
  // Lengths are meant in px of the picture; a few px of a coarse copy are too short to be told from noise.
  edges.min_length_px = std::max(10.0, edges.min_length_px / level.scale);
  edges.fill_gap_px = std::max(4.0, edges.fill_gap_px / level.scale);
  return find_edge_segments(level.flat, edges);
}

/// A circle so large that it is straight across any picture, through a segment.
Circle along(const EdgeSegment& s) {
  const Vec2 d = s.b - s.a, middle = 0.5 * (s.a + s.b);
  const Vec2 normal = (1 / norm(d)) * Vec2{-d.y, d.x};
  return {middle + 100 * kStraight * normal, 100 * kStraight};
}

}  // namespace

DropSearch search_drop_edge(const DropPicture& picture, const DropEdgeOptions& options) {
  Search search(picture, options);
  std::vector<EdgeSegments> edges;
  for (std::size_t k = 0; k < picture.levels.size() && !search.convinced(); ++k) {
    edges.push_back(segments_of(picture.levels[k], options));
    search.try_pixels(edges[k].support, edges[k].segments, k);
  }
  for (std::size_t k = 0; k < edges.size() && !search.found.accepted; ++k)
    search.try_pixels(edges[k].pixels, edges[k].segments, k);
  for (std::size_t k = 0; k < edges.size() && !search.found.accepted; ++k)
    for (std::size_t i = 0; i < std::min<std::size_t>(2, edges[k].segments.size()); ++i)
      search.try_circle(picture.levels[k].to_picture(along(edges[k].segments[i])), edges[k].segments, k);
  return std::move(search.found);
}

}  // namespace faba
