#include "field/field_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/portable_math.h"

namespace faba {
namespace {

constexpr double kParallel = 1e-9;  // cosine below which directions are perpendicular, within rounding errors

Vec2 unit(double angle) {
  const auto a = portable::sincos(angle);
  return {a.cos, a.sin};
}

}  // namespace

FieldRange::FieldRange(const Field& field, Vec3 at, std::span<const double> most) {
  std::vector<Vec3> b(field.coils());
  field.basis(at, b, {});
  const Vec3 earth = field.ambient();
  ambient_ = {earth.x, earth.y};
  for (std::size_t k = 0; k < b.size(); ++k) {
    const Vec2 largest{most[k] * b[k].x, most[k] * b[k].y};
    known_ = known_ && std::isfinite(largest.x + largest.y);
    coil_.push_back(largest);
  }
  if (!known_) return;
  // Coils whose axis is perpendicular to the plane have a rounding error in it.
  double strongest = 0;
  for (std::size_t k = 0; k < b.size(); ++k) strongest = std::max(strongest, std::fabs(most[k]) * norm(b[k]));
  std::erase_if(coil_, [&](Vec2 c) { return !(norm(c) > kParallel * strongest); });
  rounding_ = kParallel * norm(ambient_);
  for (const Vec2 c : coil_) {
    rounding_ += kParallel * norm(c);
    const Vec2 n = (1 / norm(c)) * Vec2{-c.y, c.x};
    normals_.push_back(n);
    normals_.push_back(-1.0 * n);
  }
}

double FieldRange::distance(Vec2 n) const {
  double reach = dot(n, ambient_);
  for (const Vec2 c : coil_) reach += std::fabs(dot(n, c));
  return reach;
}

// The polygon is the set of all B with B.n <= distance(n) for the normals n of its sides. Coils with parallel
// fields produce a line: the normal along the direction itself is then the only limit.
double FieldRange::along(double angle) const {
  if (!known_) return std::numeric_limits<double>::quiet_NaN();
  const Vec2 u = unit(angle);
  double least = 0, most = distance(u);
  for (const Vec2 n : normals_) {
    const double cosine = dot(n, u), d = distance(n);
    if (cosine > kParallel)
      most = std::min(most, d / cosine);
    else if (cosine < -kParallel)
      least = std::max(least, d / cosine);
    else if (d < -rounding_)
      return 0;
  }
  return most > rounding_ && least <= most + rounding_ ? most : 0;
}

FieldRange::Weakest FieldRange::weakest() const {
  if (!known_) return {0, std::numeric_limits<double>::quiet_NaN()};
  if (normals_.empty()) return {};
  Weakest least{0, std::numeric_limits<double>::max()};
  for (const Vec2 n : normals_) {
    const double d = distance(n), turn = portable::atan2(n.y, n.x),
                 angle = turn < 0 ? turn + 2 * portable::kPi : turn;
    // Of equal directions, the first counter-clockwise from the right.
    const double tie = kParallel * std::fabs(least.tesla);
    if (d < least.tesla - tie || (d < least.tesla + tie && angle < least.angle)) least = {angle, d};
  }
  // Parallel fields: the side has no length, and its distance is a rounding error.
  if (least.tesla < rounding_) least.tesla = 0;
  return least;
}

}  // namespace faba
