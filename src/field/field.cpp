#include "field/field.h"

#include <algorithm>

namespace faba {

Vec3 Field::at(Vec3 point, std::span<const double> current) const {
  Vec3 b;
  at({&point, 1}, current, {&b, 1});
  return b;
}

void Field::at(std::span<const Vec3> points, std::span<const double> current, std::span<Vec3> b) const {
  std::vector<Vec3> one(points.size());
  std::fill(b.begin(), b.end(), ambient());
  for (std::size_t k = 0; k < coils(); ++k) {
    per_ampere(k, points, one);
    for (std::size_t i = 0; i < points.size(); ++i) b[i] = b[i] + current[k] * one[i];
  }
}

std::vector<double> Field::default_currents() const {
  std::vector<double> current;
  for (std::size_t k = 0; k < coils(); ++k) current.push_back(circuit(k).current);
  return current;
}

std::vector<double> Field::max_currents(double limit) const {
  std::vector<double> most;
  for (std::size_t k = 0; k < coils(); ++k) most.push_back(std::min(limit, circuit(k).max_current));
  return most;
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
      gradient[k][0][axis] = sum.x;
      gradient[k][1][axis] = sum.y;
      gradient[k][2][axis] = sum.z;
    }
  }
}

void Field::eval(const Points& at_points, std::span<const double> current, Vectors b) const {
  std::vector<Vec3> points(at_points.x.size()), sum(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {double(at_points.x[i]), double(at_points.y[i]), double(at_points.z)};
  at(points, current, sum);
  for (std::size_t i = 0; i < points.size(); ++i) {
    b.x[i] = float(sum[i].x);
    b.y[i] = float(sum[i].y);
  }
}

}  // namespace faba
