#include "field/allocate.h"

#include <algorithm>
#include <cmath>

namespace faba {

// Least norm: I = A^T (A A^T)^-1 B, A the 2 x coils matrix of in-plane field per ampere. A A^T is 2 x 2.
std::vector<double> allocate(const Field& field, Vec3 at, Vec2 wanted) {
  std::vector<double> current(field.coils(), 0.0);
  // The coil formulas are undefined, and may not terminate, at a point that is not finite.
  if (!std::isfinite(norm(wanted)) || (field.varies() && !std::isfinite(norm(at)))) return current;
  std::vector<Vec3> b(field.coils());
  field.basis(at, b, {});
  double xx = 0, xy = 0, yy = 0;
  for (const Vec3& v : b) {
    xx += v.x * v.x;
    xy += v.x * v.y;
    yy += v.y * v.y;
  }
  const double det = xx * yy - xy * xy, trace = xx + yy;
  if (trace == 0) return current;
  Vec2 lambda;
  constexpr double kSingular = 1e-12;  // of trace^2; below it the result is dominated by rounding
  if (det > kSingular * trace * trace)
    lambda = {(yy * wanted.x - xy * wanted.y) / det, (xx * wanted.y - xy * wanted.x) / det};
  else  // the fields of all coils are parallel: pseudo-inverse of a rank-one matrix
    lambda = {(xx * wanted.x + xy * wanted.y) / (trace * trace),
              (xy * wanted.x + yy * wanted.y) / (trace * trace)};
  for (std::size_t k = 0; k < b.size(); ++k) current[k] = lambda.x * b[k].x + lambda.y * b[k].y;
  // Underflow: so far from the coils that a field or its square is rounded to zero.
  if (!std::all_of(current.begin(), current.end(), [](double i) { return std::isfinite(i); }))
    std::fill(current.begin(), current.end(), 0.0);
  return current;
}

}  // namespace faba
