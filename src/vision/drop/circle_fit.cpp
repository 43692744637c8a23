#include "vision/drop/circle_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/Core>
#include <Eigen/LU>

#include "core/error.h"
#include "core/random/splitmix64.h"
#include "core/statistics.h"

namespace faba {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr double kTukey = 4.685;  // 95 % efficiency on Gaussian residuals

/// SplitMix64 random numbers: the n-th number is a hash of seed + n * golden ratio.
class Picker {
 public:
  explicit Picker(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t n) {
    state_ += kSplitMix64Step;
    return std::size_t((splitmix64(state_) >> 32) * std::uint64_t(n) >> 32);
  }

 private:
  std::uint64_t state_;
};

/// Normal equations of the weighted geometric fit at one circle: J = d(distance - R)/d(x, y, R).
struct Normal {
  Matrix3d jtj = Matrix3d::Zero();
  Vector3d jtr = Vector3d::Zero();
  double cost = 0;
};

Normal normal_equations(std::span<const Vec2> points, std::span<const double> weights, const Circle& c) {
  Normal n;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (weights[i] <= 0) continue;
    const Vec2 d = points[i] - c.centre;
    const double length = std::max(norm(d), 1e-12);
    const double r = length - c.radius;
    const Vector3d j(-d.x / length, -d.y / length, -1);
    n.jtj += weights[i] * j * j.transpose();
    n.jtr += weights[i] * r * j;
    n.cost += weights[i] * r * r;
  }
  return n;
}

/// Inverse of a symmetric positive-definite matrix; empty when it is singular within rounding, relative to
/// the product of the diagonal, which bounds the determinant.
std::optional<Matrix3d> inverse(const Matrix3d& m) {
  if (!(m.determinant() > 1e-14 * m.diagonal().prod())) return std::nullopt;
  return m.inverse();
}

/// Levenberg-Marquardt with fixed weights; converged when a step is below 1e-10 of the radius. With
/// fixed-size normal equations for three parameters it is 1.6 times as fast as LevenbergMarquardt of Eigen
/// (unsupported module), with the same result.
Circle minimise(std::span<const Vec2> points, std::span<const double> weights, Circle c) {
  double damping = 1e-4;
  Normal now = normal_equations(points, weights, c);
  for (int iteration = 0; iteration < 100 && damping < 1e12; ++iteration) {
    Matrix3d a = now.jtj;
    a.diagonal() *= 1 + damping;
    const auto inv = inverse(a);
    const Vector3d step = inv ? Vector3d(-(*inv * now.jtr)) : Vector3d::Zero();
    const Circle next{{c.centre.x + step[0], c.centre.y + step[1]}, c.radius + step[2]};
    const Normal there = normal_equations(points, weights, next);
    if (!inv || !(next.radius > 0) || !(there.cost <= now.cost)) {
      damping *= 10;
      continue;
    }
    c = next;
    now = there;
    damping = std::max(damping / 10, 1e-12);
    if (step.lpNorm<1>() < 1e-10 * c.radius) break;
  }
  return c;
}

std::vector<double> residuals(std::span<const Vec2> points, const Circle& c) {
  std::vector<double> r(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) r[i] = norm(points[i] - c.centre) - c.radius;
  return r;
}

/// Tukey weights at scale `s`; returns Huber's variance of one residual among the points with weight > 0.
double tukey_weights(std::span<const double> r, double s, std::vector<double>& weights) {
  double psi2 = 0, slope = 0, n = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double u = r[i] / (kTukey * s), v = 1 - u * u;
    weights[i] = v > 0 ? v * v : 0;
    if (!(v > 0)) continue;
    psi2 += weights[i] * weights[i] * r[i] * r[i];
    slope += v * (1 - 5 * u * u);
    n += 1;
  }
  slope = std::max(slope / n, 0.1);
  return psi2 / std::max(n - 3, 1.0) / (slope * slope);
}

double robust_sd(std::span<const double> r) {
  std::vector<double> a(r.size());
  std::transform(r.begin(), r.end(), a.begin(), [](double x) { return std::fabs(x); });
  // Correction for the three fitted parameters, exact for least squares.
  const double n = double(r.size());
  return kMadToSd * median_high(a) * std::sqrt(n / (n - 3));
}

void fill_covariance(CircleFit& fit, std::span<const Vec2> points, double variance) {
  const std::vector<double> ones(points.size(), 1.0);
  const auto cov = inverse(normal_equations(points, ones, {fit.centre, fit.radius}).jtj);
  if (!cov)
    throw Error(Errc::input, "circle fit", "the points do not determine a circle: they are collinear");
  fit.sd_centre = {std::sqrt(variance * (*cov)(0, 0)), std::sqrt(variance * (*cov)(1, 1))};
  fit.sd_radius = std::sqrt(variance * (*cov)(2, 2));
}

/// A RANSAC hypothesis. `sense` is +1 when normals point away from the centre, -1 inward, 0: unknown.
struct Hypothesis {
  Circle circle;
  int sense = 0;
  std::size_t votes = 0;
};

/// The points with the options of the search.
struct Cloud {
  std::span<const Vec2> points, normals;
  double tolerance = 0, min_cos = 0;

  int sense(std::size_t i, const Circle& c) const {
    const Vec2 d = points[i] - c.centre;
    const double along = dot(d, normals[i]);
    if (along * along < min_cos * min_cos * dot(d, d)) return 0;
    return along > 0 ? 1 : -1;
  }
  /// Calls act(i) for every point of `which` that supports h. Uses squared distances, because this is the
  /// innermost loop of the search.
  template <class Act>
  void for_support(const Hypothesis& h, std::span<const std::size_t> which, Act act) const {
    const double inner = std::max(h.circle.radius - tolerance, 0.0), outer = h.circle.radius + tolerance;
    const double low = inner * inner, high = outer * outer;
    for (std::size_t i : which) {
      const Vec2 d = points[i] - h.circle.centre;
      const double r2 = dot(d, d);
      if (r2 >= low && r2 <= high && (h.sense == 0 || sense(i, h.circle) == h.sense)) act(i);
    }
  }
  std::size_t votes(const Hypothesis& h, std::span<const std::size_t> which) const {
    std::size_t n = 0;
    for_support(h, which, [&](std::size_t) { ++n; });
    return n;
  }
};

std::optional<Hypothesis> draw(const Cloud& cloud, const CircleSearchOptions& o, Picker& picker) {
  const std::size_t n = cloud.points.size();
  const std::size_t i = picker.below(n), j = picker.below(n), k = picker.below(n);
  const auto circle = circle_through(cloud.points[i], cloud.points[j], cloud.points[k]);
  if (!circle || circle->radius < o.min_radius || circle->radius > o.max_radius) return std::nullopt;
  Hypothesis h{*circle, 0, 0};
  if (!cloud.normals.empty()) {
    h.sense = cloud.sense(i, *circle);
    if (h.sense == 0 || cloud.sense(j, *circle) != h.sense || cloud.sense(k, *circle) != h.sense)
      return std::nullopt;
  }
  return h;
}

/// Pratt's fit to the support within 3, 1.5 and 1 tolerances, kept if the number of votes does not decrease:
/// three close points determine a circle only roughly.
void refine_on_support(Hypothesis& h, const Cloud& cloud, std::span<const std::size_t> which,
                       const CircleSearchOptions& o) {
  for (double reach : {3.0, 1.5, 1.0}) {
    Cloud wide = cloud;
    wide.tolerance = reach * cloud.tolerance;
    std::vector<Vec2> support;
    wide.for_support(h, which, [&](std::size_t i) { support.push_back(cloud.points[i]); });
    const auto refit = fit_circle_pratt(support);
    if (!refit || refit->radius < o.min_radius || refit->radius > o.max_radius) return;
    Hypothesis next{*refit, h.sense, 0};
    next.votes = cloud.votes(next, which);
    if (next.votes >= h.votes) h = next;
  }
}

std::vector<Hypothesis> draw_all(const Cloud& cloud, std::span<const std::size_t> scored,
                                 const CircleSearchOptions& o) {
  std::vector<Hypothesis> all;
  Picker picker(o.seed);
  for (int trial = 0; trial < o.trials && all.size() < o.max_hypotheses; ++trial) {
    auto h = draw(cloud, o, picker);
    if (!h) continue;
    h->votes = cloud.votes(*h, scored);
    all.push_back(*h);
  }
  return all;
}

void best_first(std::vector<Hypothesis>& all) {
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.votes > b.votes; });
}

}  // namespace

std::optional<Circle> circle_through(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 p = b - a, q = c - a;
  const double cross = 2 * (p.x * q.y - p.y * q.x), pp = dot(p, p), qq = dot(q, q);
  // A sagitta below 1e-9 of the chord is rounding.
  if (!(std::fabs(cross) > 1e-9 * std::sqrt(pp * qq))) return std::nullopt;
  const Vec2 centre{(q.y * pp - p.y * qq) / cross, (p.x * qq - q.x * pp) / cross};
  return Circle{a + centre, norm(centre)};
}

std::optional<Circle> fit_circle_pratt(std::span<const Vec2> points, std::span<const double> weights) {
  if (points.size() < 3) return std::nullopt;
  auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  Vec2 mean;
  double total = 0, spread = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mean = mean + weight(i) * points[i];
    total += weight(i);
  }
  if (!(total > 0)) return std::nullopt;
  mean = (1 / total) * mean;
  for (std::size_t i = 0; i < points.size(); ++i)
    spread += weight(i) * dot(points[i] - mean, points[i] - mean);
  spread = std::sqrt(spread / total);
  if (!(spread > 0)) return std::nullopt;
  // Moments of the points, centred and scaled so that the mean of z = x^2 + y^2 is 1.
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = (1 / spread) * (points[i] - mean);
    const double z = dot(p, p), w = weight(i) / total;
    xx += w * p.x * p.x;
    xy += w * p.x * p.y;
    yy += w * p.y * p.y;
    xz += w * p.x * z;
    yz += w * p.y * z;
    zz += w * z * z;
  }
  // With A = 1 the rows of (M - eta K) a = 0 give B, C and D; the remaining row is the quartic q(eta) = 0.
  // Its smallest root >= 0 is the minimum; Newton iterations from 0 do not overshoot it.
  double eta = 0, det = 0;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const double ex = xx - eta, ey = yy - eta, d = 1 + 2 * eta, rest = zz - d * d;
    det = ex * ey - xy * xy;
    const double q = rest * det - xz * xz * ey - yz * yz * ex + 2 * xz * yz * xy;
    const double slope = -4 * d * det - rest * (ex + ey) + xz * xz + yz * yz;
    const double step = slope < 0 ? -q / slope : 0;
    if (!(step > 1e-15)) break;
    eta += step;
  }
  const double ex = xx - eta, ey = yy - eta;
  det = ex * ey - xy * xy;
  if (!(std::fabs(det) > 1e-14)) return std::nullopt;
  const Vec2 centre{(xz * ey - yz * xy) / (2 * det), (yz * ex - xz * xy) / (2 * det)};
  const double radius2 = dot(centre, centre) + 1 + 2 * eta;
  if (!(radius2 > 0 && radius2 < 1e14)) return std::nullopt;
  return Circle{mean + spread * centre, spread * std::sqrt(radius2)};
}

CircleFit refine_circle(std::span<const Vec2> points, Circle start, CircleLoss loss) {
  if (points.size() < 4)
    throw Error(
        Errc::input, "circle fit",
        std::to_string(points.size()) + " points are too few; a circle with uncertainty needs at least 4");
  std::vector<double> weights(points.size(), 1.0), r;
  double variance = 0;
  if (loss == CircleLoss::square) {
    start = minimise(points, weights, start);
    r = residuals(points, start);
    for (double x : r) variance += x * x / double(points.size() - 3);
  } else {
    for (int round = 0; round < 20; ++round) {
      r = residuals(points, start);
      // The lower limit, far below any measured scatter, avoids division by zero for exact points.
      variance = tukey_weights(r, std::max(robust_sd(r), 1e-9 * start.radius), weights);
      const Circle before = start;
      start = minimise(points, weights, start);
      if (norm(start.centre - before.centre) + std::fabs(start.radius - before.radius) < 1e-9 * start.radius)
        break;
    }
    r = residuals(points, start);
  }
  CircleFit fit;
  fit.centre = start.centre;
  fit.radius = start.radius;
  std::vector<Vec2> kept;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (weights[i] <= 0) continue;
    fit.inliers.push_back(i);
    kept.push_back(points[i]);
    sum += r[i] * r[i];
  }
  if (kept.size() < 4)
    throw Error(Errc::input, "circle fit", "fewer than 4 points are consistent with a circle");
  fit.rms = std::sqrt(sum / double(kept.size()));
  fit.arc_rad = covered_angle(kept, fit.centre);
  fill_covariance(fit, kept, variance);
  return fit;
}

std::vector<Circle> search_circles(std::span<const Vec2> points, std::span<const Vec2> normals,
                                   const CircleSearchOptions& o) {
  std::vector<Circle> found;
  if (points.size() < 4) return found;
  const Cloud cloud{points, normals, o.tolerance, std::cos(o.max_turn_deg * std::numbers::pi / 180)};
  std::vector<std::size_t> every(points.size()), scored;
  std::iota(every.begin(), every.end(), std::size_t{0});
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + o.max_scored - 1) / o.max_scored);
  for (std::size_t i = 0; i < points.size(); i += stride) scored.push_back(i);

  std::vector<Hypothesis> all = draw_all(cloud, scored, o);
  best_first(all);
  // Votes only decrease as circles are found, so the worst hypotheses can be discarded.
  if (all.size() > 200) all.resize(200);
  for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 40); ++i)
    refine_on_support(all[i], cloud, scored, o);
  best_first(all);
  while (int(found.size()) < o.max_circles && !all.empty() && all.front().votes >= 4) {
    Hypothesis best = all.front();
    best.votes = cloud.votes(best, every);
    refine_on_support(best, cloud, every, o);
    found.push_back(best.circle);
    std::erase_if(scored, [&](std::size_t i) {
      return std::fabs(norm(points[i] - best.circle.centre) - best.circle.radius) <= 2 * o.tolerance;
    });
    for (Hypothesis& h : all) h.votes = cloud.votes(h, scored);
    best_first(all);
  }
  return found;
}

CircleFit fit_circle(std::span<const Vec2> points, const CircleSearchOptions& options) {
  CircleSearchOptions o = options;
  o.max_circles = 1;
  const std::vector<Circle> found = search_circles(points, {}, o);
  if (found.empty())
    throw Error(Errc::input, "circle fit",
                "no circle is supported by at least 4 points; check that the points contain an arc");
  std::vector<Vec2> near;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::fabs(norm(points[i] - found[0].centre) - found[0].radius) > 3 * o.tolerance) continue;
    near.push_back(points[i]);
    index.push_back(i);
  }
  CircleFit fit = refine_circle(near, found[0], CircleLoss::tukey);
  for (std::size_t& i : fit.inliers) i = index[i];
  return fit;
}

double covered_angle(std::span<const Vec2> points, Vec2 centre) {
  if (points.empty()) return 0;
  std::vector<double> angle(points.size());
  std::transform(points.begin(), points.end(), angle.begin(),
                 [&](Vec2 p) { return std::atan2(p.y - centre.y, p.x - centre.x); });
  std::sort(angle.begin(), angle.end());
  double gap = angle.front() + 2 * std::numbers::pi - angle.back();
  for (std::size_t i = 1; i < angle.size(); ++i) gap = std::max(gap, angle[i] - angle[i - 1]);
  return 2 * std::numbers::pi - gap;
}

}  // namespace faba
