#include "field/field.h"

#include <algorithm>

namespace faba {

Vec3 Field::at(Vec3 point, std::span<const double> current) const {
  std::vector<Vec3> b(coils());
  basis(point, b, {});
  Vec3 sum = ambient();
  for (std::size_t k = 0; k < b.size(); ++k) sum = sum + current[k] * b[k];
  return sum;
}

void Field::basis(Vec3 at, std::span<Vec3> b, std::span<Mat3> gradient) const {
  for (std::size_t k = 0; k < b.size(); ++k) per_ampere(k, {&at, 1}, b.subspan(k, 1));
  if (gradient.empty()) return;
  constexpr std::array<double, 3> kWeight{45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double step = 0.01 * std::clamp(clearance(at), 1e-6, 1.0);
  std::array<Vec3, 18> points, values;  // axis, distance, side
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d = step * double(i / 2 % 3 + 1) * (i % 2 ? -1 : 1);
    points[i] = at + Vec3{i / 6 == 0 ? d : 0, i / 6 == 1 ? d : 0, i / 6 == 2 ? d : 0};
  }
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    per_ampere(k, points, values);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3 sum;
      for (std::size_t j = 0; j < 3; ++j)
        sum = sum + (kWeight[j] / step) * (values[6 * axis + 2 * j] - values[6 * axis + 2 * j + 1]);
      gradient[k][0][axis] = sum.x, gradient[k][1][axis] = sum.y, gradient[k][2][axis] = sum.z;
    }
  }
}

void Field::eval(const Points& at, std::span<const double> current, Vectors b) const {
  std::vector<Vec3> points(at.x.size()), one(at.x.size()), sum(at.x.size(), ambient());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {double(at.x[i]), double(at.y[i]), double(at.z)};
  for (std::size_t k = 0; k < coils(); ++k) {
    per_ampere(k, points, one);
    for (std::size_t i = 0; i < points.size(); ++i) sum[i] = sum[i] + current[k] * one[i];
  }
  for (std::size_t i = 0; i < points.size(); ++i) b.x[i] = float(sum[i].x), b.y[i] = float(sum[i].y);
}

}  // namespace faba
