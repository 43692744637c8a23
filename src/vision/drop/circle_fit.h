#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "vision/image/circle.h"

namespace faba {

/// Circle geometry in a plane, independent of pictures. Lengths are in the unit of the points (here px), in
/// the frame of the points.

/// A circle fitted to points, with its uncertainty.
struct CircleFit {
  Vec2 centre;
  double radius = 0;
  Vec2 sd_centre;        ///< standard deviations of centre.x and centre.y
  double sd_radius = 0;  ///< standard deviation of the radius
  double arc_rad = 0;    ///< angle covered by the inliers, seen from the centre: 2 pi - largest gap
  double rms = 0;        ///< root mean square distance of the inliers from the circle
  std::vector<std::size_t> inliers;  ///< indices of the points, ascending
};

/// The circle through three points; empty when they are collinear within rounding.
std::optional<Circle> circle_through(Vec2 a, Vec2 b, Vec2 c);

/// Pratt's algebraic fit: minimises sum w (A(x^2+y^2) + Bx + Cy + D)^2 under B^2 + C^2 - 4AD = 1. Needs no
/// initial value and is nearly free of the bias to small radii of the Kasa fit on short arcs (theory A13).
/// `weights`: empty (all 1) or one weight >= 0 per point. Empty for fewer than three points or collinear
/// points.
std::optional<Circle> fit_circle_pratt(std::span<const Vec2> points, std::span<const double> weights = {});

/// Loss function of refine_circle.
enum class CircleLoss {
  square,  ///< least squares: efficient without outliers
  tukey    ///< Tukey's biweight at 4.685 robust sd: 95 % efficiency, points beyond have weight 0
};

/// Minimises the distances of the points from the circle (Levenberg-Marquardt on centre and radius), starting
/// at `start`, which must be close. The covariance is s^2 (J^T J)^-1 with s^2 from the residuals (for Tukey:
/// Huber's sum psi^2/(n-3) / (mean psi')^2). On an arc of half-angle a with n points of scatter sigma, sd(R)
/// = sigma sqrt(45/n)/a^2 (theory A13). For Tukey the inliers are the points with weight > 0. Throws
/// Error(Errc::input) for fewer than 4 points or when the points do not determine a circle.
CircleFit refine_circle(std::span<const Vec2> points, Circle start, CircleLoss loss = CircleLoss::tukey);

/// Options of the RANSAC search for circles.
struct CircleSearchOptions {
  double tolerance = 1.5;             ///< maximum distance of a supporting point; > 0
  double min_radius = 10;             ///< smaller circles are not considered
  double max_radius = 1e5;            ///< larger circles are not considered
  int trials = 20000;                 ///< number of random triples of points; >= 1
  std::size_t max_hypotheses = 1000;  ///< maximum number of scored circles (with matching normals)
  int max_circles = 1;                ///< maximum number of circles returned
  double max_turn_deg = 25;      ///< with normals: maximum angle between the normal of a point and the radius
  std::size_t max_scored = 600;  ///< maximum number of points for scoring, evenly subsampled
  std::uint64_t seed = 1;        ///< the result is reproducible on every machine
};

/// RANSAC: circles through random triples of points, scored by the number of points within the tolerance,
/// then refined by Pratt's fit to their support; best first, each next circle scored on the points that the
/// previous ones do not explain. `normals` is empty or has one unit vector per point, across the edge from
/// dark to bright; a point then supports a circle only if its normal is along the radius and has the same
/// sense (in or out) as those of the other supporters. Clutter of small spots with random normals loses about
/// nine tenths of its votes.
std::vector<Circle> search_circles(std::span<const Vec2> points, std::span<const Vec2> normals,
                                   const CircleSearchOptions& options = {});

/// Robust fit to points with outliers: search_circles, Pratt, refine_circle (Tukey) on the points within 3
/// tolerances. Throws Error(Errc::input) when no circle is supported by at least 4 points.
CircleFit fit_circle(std::span<const Vec2> points, const CircleSearchOptions& options = {});

/// Angle covered by points as seen from `centre`: 2 pi minus the largest gap between neighbours; rad.
double covered_angle(std::span<const Vec2> points, Vec2 centre);

}  // namespace faba
