#include "field/null.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/portable_math.h"

namespace faba {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kRank = 1e-9;  // singular values below this fraction of the largest are rounding errors

/// Field and gradient of every coil at a point.
struct Local {
  std::vector<Vec3> b;
  std::vector<Mat3> g;
  Local(const Field& field, Vec2 at) : b(field.coils()), g(field.coils()) {
    field.basis({at.x, at.y, 0}, b, g);
  }
};

/// The in-plane gradient of a linear combination, as c(angle) = mean + along cos(2 angle) + across sin(2
/// angle), the slope of B along a direction; each is a vector over the combined quantities.
struct Slope {
  Vector mean, along, across;
  Vector at(double cos2, double sin2) const { return mean + cos2 * along + sin2 * across; }
  double size() const { return mean.norm() + along.norm() + across.norm(); }
};

// The steepest slope in any direction: used when nothing traps along both axes.
Vector strongest_slope(const Slope& c) {
  Vector best = c.at(1, 0);
  for (int i = 1; i < 720; ++i) {
    const auto angle = portable::sincos(portable::kPi * i / 360);
    const Vector now = c.at(angle.cos, angle.sin);
    if (now.norm() > best.norm()) best = now;
  }
  return best.norm() > 0 ? Vector(best.normalized()) : Vector();
}

// Currents here are in units of each coil's limit, so that all limits are 1.

/// The largest s for which all currents of start + s direction are within their limits; negative when one of
/// `start` is not.
double largest_step(const Vector& start, const Vector& direction) {
  double s = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    if (std::fabs(start[k]) > 1 + 1e-12) return -1;
    if (direction[k] != 0)
      s = std::min(s, (1 - std::copysign(1.0, direction[k]) * start[k]) / std::fabs(direction[k]));
  }
  return s;
}

/// Of all currents with a I = wanted those with the least sum of squares or, when these exceed a limit, those
/// with the smallest maximum, by Lawson's reweighting: currents near their limit get a larger weight in the
/// next iteration.
Vector least_currents(const Matrix& a, const Eigen::Vector2d& wanted) {
  Vector weight = Vector::Ones(a.cols()), best;
  for (int i = 0; i < 100; ++i) {
    const Vector scale = weight.cwiseSqrt().cwiseInverse();
    Eigen::JacobiSVD<Matrix> svd(a * scale.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(kRank);
    const Vector now = scale.asDiagonal() * svd.solve(wanted);
    const double most = now.cwiseAbs().maxCoeff();
    if (best.size() == 0 || most < best.cwiseAbs().maxCoeff()) best = now;
    if (most < 0.999) break;
    weight = weight.cwiseProduct(now.cwiseAbs());
    weight = (weight / weight.maxCoeff()).cwiseMax(1e-12);
  }
  return best;
}

/// Slope along the direction of the weakest trap; positive when the currents trap.
double weakest_slope(const Slope& c, const Vector& current) {
  return c.mean.dot(current) - norm(Vec2{c.along.dot(current), c.across.dot(current)});
}

/// The currents start + free y within the limits for which weakest_slope() is largest. It is a concave
/// function of y and the limits are convex, so the maximum is unique. Newton's method on a barrier,
///   maximise  weight t + log((mean - t)^2 - along^2 - across^2) + sum of log(1 - current^2)  over y and t,
/// with increasing weight. `start` is inside the limits.
class BestTrap {
 public:
  BestTrap(const Slope& c, const Vector& start, const Matrix& free) : start_(start), free_(free) {
    const double unit = std::max({c.mean.norm(), c.along.norm(), c.across.norm(), 1e-300});
    c_ = {c.mean / unit, c.along / unit, c.across / unit};
    const Eigen::Index n = free.cols() + 1;
    for (auto* g : {&mean_, &along_, &across_}) *g = Vector::Zero(n);
    mean_ << free.transpose() * c_.mean, -1.0;
    along_.head(n - 1) = free.transpose() * c_.along;
    across_.head(n - 1) = free.transpose() * c_.across;
  }
  Vector solve() const {
    constexpr int kDecades = 10;  // the distance from the maximum is about 10 / (final weight)
    Vector z = Vector::Zero(free_.cols() + 1);
    z[z.size() - 1] = weakest_slope(c_, start_) - 1;
    double weight = 1;
    for (int decade = 0; decade <= kDecades; ++decade, weight *= 10)
      for (int i = 0; i < 50; ++i)
        if (!step(weight, z)) break;
    return current(z);
  }

 private:
  Vector current(const Vector& z) const { return start_ + free_ * z.head(free_.cols()); }
  /// The function to minimise; infinite outside the limits.
  double barrier(double weight, const Vector& z) const {
    const Vector x = current(z), inside = 1 - x.array().square();
    const double r = c_.mean.dot(x) - z[z.size() - 1], a = c_.along.dot(x), b = c_.across.dot(x);
    const double cone = r * r - a * a - b * b;
    if (!(r > 0 && cone > 0 && inside.minCoeff() > 0)) return std::numeric_limits<double>::infinity();
    double sum = -weight * z[z.size() - 1] - portable::log(cone);
    for (const double v : inside) sum -= portable::log(v);
    return sum;
  }
  bool step(double weight, Vector& z) const {
    const Eigen::Index n = z.size();
    const Vector x = current(z), inside = 1 - x.array().square();
    const double r = c_.mean.dot(x) - z[n - 1], a = c_.along.dot(x), b = c_.across.dot(x);
    const double cone = r * r - a * a - b * b;
    const Vector of_cone = 2 * (r * mean_ - a * along_ - b * across_);
    Vector slope = -of_cone / cone;
    slope[n - 1] -= weight;
    slope.head(n - 1) += free_.transpose() * (2 * x.array() / inside.array()).matrix();
    const Vector bend = 2 * (1 + x.array().square()) / inside.array().square();
    Matrix h = of_cone * of_cone.transpose() / (cone * cone) -
               (2 / cone) *
                   (mean_ * mean_.transpose() - along_ * along_.transpose() - across_ * across_.transpose());
    h.topLeftCorner(n - 1, n - 1) += free_.transpose() * bend.asDiagonal() * free_;
    const Vector p = -h.ldlt().solve(slope);
    const double gain = -slope.dot(p), before = barrier(weight, z);
    if (!(gain > 1e-9)) return false;
    double fraction = 1;
    for (int halving = 0; halving < 30; ++halving, fraction *= 0.5)
      if (barrier(weight, z + fraction * p) < before - 0.1 * fraction * gain) {
        z += fraction * p;
        return true;
      }
    return false;
  }

  Slope c_;
  Vector start_;
  Matrix free_;
  Vector mean_, along_, across_;  ///< slopes of r, a and b in step()
};

/// Eigenvalues of the in-plane part of the gradient, and dB_z/dz.
struct LocalGradient {
  std::array<double, 2> in_plane;
  double along_z;
};
LocalGradient local_gradient(const Local& local, std::span<const double> current) {
  double xx = 0, xy = 0, yy = 0, zz = 0;
  for (std::size_t k = 0; k < current.size(); ++k) {
    xx += current[k] * local.g[k][0][0];
    yy += current[k] * local.g[k][1][1];
    xy += current[k] * 0.5 * (local.g[k][0][1] + local.g[k][1][0]);
    zz += current[k] * local.g[k][2][2];
  }
  const double mean = 0.5 * (xx + yy), half = norm(Vec2{0.5 * (xx - yy), xy});
  return {{mean - half, mean + half}, zz};
}

}  // namespace

FieldNull null_at(const Field& field, Vec2 at, int polarity, std::span<const double> most, bool with_earth) {
  const Local local(field, at);
  const auto n = Eigen::Index(local.b.size());
  Matrix a(2, n);
  Slope c{Vector(n), Vector(n), Vector(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const double unit = most[std::size_t(k)];
    const Vec3& b = local.b[std::size_t(k)];
    const Mat3& g = local.g[std::size_t(k)];
    a.col(k) << unit * b.x, unit * b.y;
    c.mean[k] = -polarity * 0.5 * unit * (g[0][0] + g[1][1]);
    c.along[k] = -polarity * 0.5 * unit * (g[0][0] - g[1][1]);
    c.across[k] = -polarity * 0.5 * unit * (g[0][1] + g[1][0]);
  }
  if (!a.allFinite() || !c.mean.allFinite() || !c.along.allFinite() || !c.across.allFinite()) {
    // In a winding, or outside a measured map.
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    return {std::vector<double>(std::size_t(n)), {kUnknown, kUnknown}, kUnknown, false, true};
  }
  const Vec3 earth = with_earth ? field.ambient() : Vec3{};
  const Eigen::Vector2d wanted(-earth.x, -earth.y);
  Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(kRank);
  const Matrix free = svd.matrixV().rightCols(n - svd.rank());
  const Vector start = least_currents(a, wanted);

  FieldNull out;
  Vector current = start;
  const bool zero = (a * start - wanted).norm() <= 1e-9 * (wanted.norm() + 1e-12);
  if (zero && free.cols() > 0) {
    const Slope combined{free.transpose() * c.mean, free.transpose() * c.along, free.transpose() * c.across};
    const double inside = largest_step(start, Vector::Zero(n));
    if (inside > 0 && combined.size() > 0) {
      out.reachable = true;
      if (start.cwiseAbs().maxCoeff() < 1) current = BestTrap(c, start, free).solve();
      if (!(weakest_slope(c, current) > 0)) {  // no trap at this point within the limits
        const Vector direction = free * strongest_slope(combined);
        current = start + largest_step(start, direction) * direction;
      }
    }
  }
  for (Eigen::Index k = 0; k < n; ++k) out.current.push_back(most[std::size_t(k)] * current[k]);
  const LocalGradient m = local_gradient(local, out.current);
  out.gradient = m.in_plane;
  out.out_of_plane = m.along_z;
  // North-seeking cells swim along B: they gather where B points inwards.
  out.saddle = !(polarity > 0 ? m.in_plane[1] < 0 : m.in_plane[0] > 0);
  return out;
}

NullGradient null_gradient(const Field& field, std::span<const double> current, Vec2 at) {
  return local_gradient(Local(field, at), current).in_plane;
}

std::vector<double> current_limits(const Field& field) {
  std::vector<double> most;
  for (std::size_t k = 0; k < field.coils(); ++k) {
    const double limit = field.circuit(k).max_current;
    most.push_back(std::isfinite(limit) ? limit : 1.0);
  }
  return most;
}

Vec2 find_null(const Field& field, std::span<const double> current, Vec2 from) {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 50; ++i) {
    const Local local(field, from);
    Eigen::Vector2d b(field.ambient().x, field.ambient().y);
    Eigen::Matrix2d g = Eigen::Matrix2d::Zero();
    for (std::size_t k = 0; k < current.size(); ++k) {
      b += current[k] * Eigen::Vector2d(local.b[k].x, local.b[k].y);
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c) g(r, c) += current[k] * local.g[k][std::size_t(r)][std::size_t(c)];
    }
    double field_scale = 0;  // sum of the field magnitudes of the coils: scale for the tolerance of the zero
    for (std::size_t k = 0; k < current.size(); ++k)
      field_scale += std::fabs(current[k]) * norm(Vec2{local.b[k].x, local.b[k].y});
    const Eigen::Vector2d step = g.fullPivLu().solve(b);
    // The gradient is not valid beyond the nearest coil: the step is limited to half the distance to it.
    const double most = 0.5 * field.clearance({from.x, from.y, 0});
    const double length = step.norm();
    if (!std::isfinite(length) || !(most > 0)) break;
    const double fraction = length > most ? most / length : 1;
    from = from - fraction * Vec2{step[0], step[1]};
    if (length < 1e-12 && b.norm() < 1e-9 * field_scale) return from;
    if (length < 1e-12) break;
  }
  return {kNowhere, kNowhere};
}

}  // namespace faba
