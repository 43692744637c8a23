#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "vision/image/circle.h"

namespace faba {

/// Pure geometry of circles in a plane. Every length is in the unit of the points (here px), every frame is
/// the frame of the points. Nothing here knows pictures.

/// A circle fitted to points, with its uncertainty.
struct CircleFit {
  Vec2 centre;
  double radius = 0;
  Vec2 sd_centre;                    ///< standard deviations of centre.x and centre.y
  double sd_radius = 0;              ///< standard deviation of the radius
  double arc_rad = 0;                ///< angle the inliers cover as seen from the centre: 2 pi - largest gap
  double rms = 0;                    ///< root mean square distance of the inliers from the circle
  std::vector<std::size_t> inliers;  ///< indices into the points given, ascending
};

/// The circle through three points; nothing when they lie on a line to within rounding.
std::optional<Circle> circle_through(Vec2 a, Vec2 b, Vec2 c);

/// Pratt's algebraic fit: minimises sum w (A(x^2+y^2) + Bx + Cy + D)^2 under B^2 + C^2 - 4AD = 1. It needs no
/// start and is nearly free of the pull to small radii that the simple (Kasa) fit has on short arcs
/// (theory A13). `weights` is empty (all 1) or as long as `points`, each >= 0.
/// Nothing for fewer than three points or points on a line.
std::optional<Circle> fit_circle_pratt(std::span<const Vec2> points, std::span<const double> weights = {});

/// How refine_circle treats points far from the circle.
enum class CircleLoss {
  square,  ///< least squares: efficient when every point is good
  tukey    ///< Tukey's biweight at 4.685 robust sd: 95 % efficient, points beyond have no say
};

/// Minimises the distances of the points from the circle (Levenberg-Marquardt on centre and radius) from
/// `start`, which must be near. The covariance is s^2 (J^T J)^-1 with s^2 from the residuals (for Tukey:
/// Huber's sum psi^2/(n-3) / (mean psi')^2). On an arc of half-angle a with n points of scatter sigma it
/// gives sd(R) = sigma sqrt(45/n)/a^2 (theory A13). For Tukey the inliers are the points with weight >
/// 0. Throws Error(Errc::input) for fewer than 4 points or when the points do not determine a circle.
CircleFit refine_circle(std::span<const Vec2> points, Circle start, CircleLoss loss = CircleLoss::tukey);

/// Options of the random search for circles.
struct CircleSearchOptions {
  double tolerance = 1.5;   ///< a point this near to a circle supports it; > 0
  double min_radius = 10;   ///< smaller circles are not considered
  double max_radius = 1e5;  ///< larger circles are not considered
  int trials = 20000;       ///< random triples of points to try; >= 1
  std::size_t max_hypotheses =
      1000;                  ///< trials end when this many circles (with fitting normals) were scored
  int max_circles = 1;       ///< how many different circles to return at most
  double max_turn_deg = 25;  ///< with normals: largest angle between a point's normal and the radius there
  std::size_t max_scored = 600;  ///< a hypothesis is scored on at most this many points, evenly picked
  std::uint64_t seed = 1;        ///< same seed, points and options: same circles, on every machine
};

/// RANSAC: circles through random triples of points, scored by the number of points they pass near, then
/// polished with Pratt's fit on their support; best first, each next one scored on what the ones before it
/// left over. `normals` is empty or as long as `points`: unit vectors across the edge from dark to bright;
/// then a point supports a circle only if its normal lies along the radius, and all supporters point the same
/// way (in or out). Clutter of small spots, whose normals point everywhere, so loses about nine tenths of its
/// votes.
std::vector<Circle> search_circles(std::span<const Vec2> points, std::span<const Vec2> normals,
                                   const CircleSearchOptions& options = {});

/// The whole chain for points of which some are wrong: search_circles, Pratt, refine_circle (Tukey) on the
/// points within 3 tolerances. Throws Error(Errc::input) when no circle is supported by at least 4 points.
CircleFit fit_circle(std::span<const Vec2> points, const CircleSearchOptions& options = {});

/// Angle covered by points as seen from `centre`: 2 pi minus the largest gap between neighbours; rad.
double covered_angle(std::span<const Vec2> points, Vec2 centre);

}  // namespace faba
