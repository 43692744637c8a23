#pragma once
#include <array>
#include <cmath>

namespace faba {

/// Vector in the plane; frame and unit are part of the variable's name.
struct Vec2 {
  double x = 0, y = 0;
  friend Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
  friend bool operator==(const Vec2&, const Vec2&) = default;
};
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// Euclidean norm. sqrt is correctly rounded everywhere, std::hypot is not; this makes runs bit-identical.
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }

struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Symmetric 2x2 matrix, here always a covariance.
struct Mat2 {
  double xx = 0, xy = 0, yy = 0;
  friend Mat2 operator+(Mat2 a, Mat2 b) { return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy}; }
  friend Mat2 operator*(double s, Mat2 a) { return {s * a.xx, s * a.xy, s * a.yy}; }
};
/// Row-major 3x3 matrix; as a gradient, element [i][j] is d B_i / d x_j.
using Mat3 = std::array<std::array<double, 3>, 3>;

}  // namespace faba
