#pragma once
#include <cmath>
#include <vector>

#include "core/vec.h"

namespace faba {

/// Reference calculation of the field of a coil: Biot and Savart's law summed over the pieces of its wire. A
/// coil is a set of loops with a number of turns each.
struct Wire {
  struct Loop {
    Vec3 centre, axis;  ///< axis of length 1
    double radius, turns;
  };
  std::vector<Loop> loops;
};

inline Vec3 unit(Vec3 v) { return (1 / norm(v)) * v; }

/// T/A. The pieces are equal angles: for a periodic integrand the error decreases exponentially with their
/// number.
inline Vec3 biot_savart(const Wire& wire, Vec3 at) {
  constexpr int kPieces = 400;
  constexpr double kMu0Over4Pi = 1.25663706127e-6 / (4 * 3.14159265358979323846);
  Vec3 sum;
  for (const auto& l : wire.loops) {
    const Vec3 u = unit(cross(l.axis, std::fabs(l.axis.x) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               v = cross(l.axis, u);
    for (int i = 0; i < kPieces; ++i) {
      const double phi = 2 * 3.14159265358979323846 * i / kPieces;
      const Vec3 out = std::cos(phi) * u + std::sin(phi) * v;
      const Vec3 piece = (l.radius * 2 * 3.14159265358979323846 / kPieces) * cross(l.axis, out);
      const Vec3 r = at - (l.centre + l.radius * out);
      const double d2 = r.x * r.x + r.y * r.y + r.z * r.z;
      sum = sum + (kMu0Over4Pi * l.turns / (d2 * std::sqrt(d2))) * cross(piece, r);
    }
  }
  return sum;
}

/// Nodes and weights of a Gauss-Legendre rule on (-1, 1), by Newton's method.
inline std::vector<Vec2> gauss(int n) {
  std::vector<Vec2> rule;
  for (int i = 1; i <= n; ++i) {
    double x = std::cos(3.14159265358979323846 * (i - 0.25) / (n + 0.5)), slope = 1;
    for (int k = 0; k < 20; ++k) {
      double p0 = 1, p1 = x;
      for (int j = 2; j <= n; ++j) {
        const double p2 = ((2 * j - 1) * x * p1 - (j - 1) * p0) / j;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    rule.push_back({x, 2 / ((1 - x * x) * slope * slope)});
  }
  return rule;
}

inline Wire loops(const std::vector<Vec3>& centres, Vec3 axis, double radius,
                  const std::vector<double>& turns) {
  Wire w;
  for (std::size_t i = 0; i < centres.size(); ++i)
    w.loops.push_back({centres[i], unit(axis), radius, turns[i]});
  return w;
}

/// A sheet as loops at the nodes of a Gauss rule along its length.
inline Wire sheet(Vec3 centre, Vec3 axis, double radius, double length, double turns) {
  Wire w;
  for (const Vec2 node : gauss(48))
    w.loops.push_back(
        {centre + (0.5 * length * node.x) * unit(axis), unit(axis), radius, 0.5 * node.y * turns});
  return w;
}

inline Wire thick(Vec3 centre, Vec3 axis, double inner, double outer, double length, double turns) {
  Wire w;
  for (const Vec2 node : gauss(20)) {
    const Wire s = sheet(centre, axis, 0.5 * (inner + outer) + 0.5 * (outer - inner) * node.x, length,
                         0.5 * node.y * turns);
    w.loops.insert(w.loops.end(), s.loops.begin(), s.loops.end());
  }
  return w;
}

}  // namespace faba
