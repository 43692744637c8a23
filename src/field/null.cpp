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

constexpr double kRank = 1e-9;  // singular values below this share of the first are rounding

/// Field and gradient of every coil at a point.
struct Local {
  std::vector<Vec3> b;
  std::vector<Mat3> g;
  Local(const Field& field, Vec2 at) : b(field.coils()), g(field.coils()) {
    field.basis({at.x, at.y, 0}, b, g);
  }
};

/// The in-plane gradient of a linear combination, as c(angle) = mean + along cos(2 angle) + across sin(2
/// angle), the slope of B along a direction; each is a vector over what is combined.
struct Slope {
  Vector mean, along, across;
  Vector at(double cos2, double sin2) const { return mean + cos2 * along + sin2 * across; }
};

// The direction y of unit length for which the smallest of c(angle).y is largest is that of the point nearest
// to the origin of the disc { mean + w_1 along + w_2 across, |w| <= 1 }: min and max change places, and the
// disc is what the curve c(angle) spans. Not there when the disc holds the origin.
Vector best_trap(const Slope& c) {
  Matrix m(c.mean.size(), 2);
  m << c.along, c.across;
  const Eigen::Matrix2d h = m.transpose() * m;
  const Eigen::Vector2d t = m.transpose() * c.mean;
  const double size = std::sqrt(h.trace()) + c.mean.norm();
  const auto w = [&](double lambda) -> Eigen::Vector2d {
    return -(h + lambda * Eigen::Matrix2d::Identity()).ldlt().solve(t);
  };
  double low = 1e-14 * size * size, high = t.norm() + low;
  Eigen::Vector2d best = w(low);
  if (best.norm() > 1) {
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (w(middle).norm() > 1 ? low : high) = middle;
    }
    best = w(high);
  }
  const Vector nearest = c.mean + m * best;
  return nearest.norm() < 1e-6 * size ? Vector() : Vector(nearest.normalized());
}

// The steepest slope in any direction: what is left when nothing traps along both axes.
Vector strongest_slope(const Slope& c) {
  Vector best = c.at(1, 0);
  for (int i = 1; i < 720; ++i) {
    const auto angle = portable::sincos(portable::kPi * i / 360);
    const Vector now = c.at(angle.cos, angle.sin);
    if (now.norm() > best.norm()) best = now;
  }
  return best.norm() > 0 ? Vector(best.normalized()) : Vector();
}

/// The largest s for which |start + s direction| stays within `most`; negative when `start` does not.
double room(const Vector& start, const Vector& direction, std::span<const double> most) {
  double s = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    const double limit = most[std::size_t(k)];
    if (std::fabs(start[k]) > limit * (1 + 1e-12)) return -1;
    if (direction[k] != 0)
      s = std::min(s, (limit - std::copysign(1.0, direction[k]) * start[k]) / std::fabs(direction[k]));
  }
  return s;
}

/// Slope of all coils along the direction in which currents `i` trap least, T/m; positive when they trap.
double weakest(const Slope& c, const Vector& i) {
  return c.mean.dot(i) - norm(Vec2{c.along.dot(i), c.across.dot(i)});
}

// Turns the direction `y` in the free currents until the weaker trap is strongest at the current limits,
// which favour directions that use all coils alike. With four coils that is a search along one angle with one
// maximum; with more, a local search from the direction that is best for the norm of the currents.
Vector turned_to_limits(const Slope& all, const Vector& start, const Matrix& free, Vector y,
                        std::span<const double> most) {
  const auto value = [&](const Vector& direction) {
    const Vector through = free * direction;
    return weakest(all, start + std::max(room(start, through, most), 0.0) * through);
  };
  constexpr int kHalvings = 32;  // down to 1e-10
  double best = value(y), step = 0.5;
  for (int halving = 0; halving < kHalvings; ++halving, step *= 0.5)
    for (bool better = true; better;) {
      better = false;
      for (Eigen::Index axis = 0; axis < y.size(); ++axis)
        for (const double side : {-1.0, 1.0}) {
          Vector next = y;
          next[axis] += side * step;
          next.normalize();
          if (const double v = value(next); v > best * (1 + 1e-14)) best = v, y = next, better = true;
        }
    }
  return y;
}

/// Eigenvalues of the in-plane part of the gradient, and dB_z/dz.
struct Measured {
  std::array<double, 2> in_plane;
  double along_z;
};
Measured measured(const Local& local, std::span<const double> current) {
  double xx = 0, xy = 0, yy = 0, zz = 0;
  for (std::size_t k = 0; k < current.size(); ++k) {
    xx += current[k] * local.g[k][0][0], yy += current[k] * local.g[k][1][1];
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
  for (Eigen::Index k = 0; k < n; ++k) a.col(k) << local.b[std::size_t(k)].x, local.b[std::size_t(k)].y;
  const Vec3 earth = with_earth ? field.ambient() : Vec3{};
  const Eigen::Vector2d wanted(-earth.x, -earth.y);
  Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(kRank);
  const Eigen::Index rank = svd.rank();
  const Vector start = svd.solve(wanted);
  const Matrix free = svd.matrixV().rightCols(n - rank);

  FieldNull out;
  out.current.assign(start.begin(), start.end());
  const bool zero = (a * start - wanted).norm() <= 1e-9 * (wanted.norm() + 1e-12);
  if (zero && free.cols() > 0) {
    Slope c{Vector::Zero(n), Vector::Zero(n), Vector::Zero(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const Mat3& g = local.g[std::size_t(k)];
      c.mean[k] = -polarity * 0.5 * (g[0][0] + g[1][1]);
      c.along[k] = -polarity * 0.5 * (g[0][0] - g[1][1]);
      c.across[k] = -polarity * 0.5 * (g[0][1] + g[1][0]);
    }
    const Slope combined{free.transpose() * c.mean, free.transpose() * c.along, free.transpose() * c.across};
    Vector y = best_trap(combined);
    y = y.size() > 0 ? turned_to_limits(c, start, free, y, most) : strongest_slope(combined);
    if (y.size() > 0) {
      const Vector direction = free * y;
      const double s = room(start, direction, most);
      out.reachable = s > 0;
      const Vector current = start + std::max(s, 0.0) * direction;
      out.current.assign(current.begin(), current.end());
    }
  }
  const Measured m = measured(local, out.current);
  out.gradient = m.in_plane;
  out.out_of_plane = m.along_z;
  // North-seeking cells swim along B: they come together where B points inwards.
  out.saddle = !(polarity > 0 ? m.in_plane[1] < 0 : m.in_plane[0] > 0);
  return out;
}

NullGradient null_gradient(const Field& field, std::span<const double> current, Vec2 at) {
  return measured(Local(field, at), current).in_plane;
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
    double made = 0;  // by the coils one by one: what a zero is small against
    for (std::size_t k = 0; k < current.size(); ++k)
      made += std::fabs(current[k]) * norm(Vec2{local.b[k].x, local.b[k].y});
    const Eigen::Vector2d step = g.fullPivLu().solve(b);
    // A step longer than the way to the nearest coil is no step towards a zero that this gradient knows of.
    const double most = 0.5 * field.clearance({from.x, from.y, 0});
    const double length = step.norm();
    if (!std::isfinite(length) || !(most > 0)) break;
    const double share = length > most ? most / length : 1;
    from = from - share * Vec2{step[0], step[1]};
    if (length < 1e-12 && b.norm() < 1e-9 * made) return from;
    if (length < 1e-12) break;
  }
  return {kNowhere, kNowhere};
}

}  // namespace faba
