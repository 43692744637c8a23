#include "field/kernels/axial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/portable.h"
#include "core/portable_math.h"
#include "core/vectorised.h"

namespace faba::axial {
namespace {

// Complete elliptic integrals by the arithmetic-geometric mean, Bulirsch's cel (theory C1), for tiles of
// points with the same number of passes, so that loops over points vectorise. Convergence is quadratic: the
// number of passes follows from the smallest complementary modulus kc of a tile. Each pass is a separate
// short loop over the tile, so that the processor works on many points in parallel.
constexpr std::size_t kTile = 128;
// One cache line more than the tile; otherwise all columns would map to the same set of the first-level
// cache.
using Column = std::array<double, kTile + 8>;

/// 1 / sqrt(x) by four steps of Newton's method from an initial guess based on the bits of x (positive and
/// normal); the error is a few roundings. Division and square root share one slow unit of the processor;
/// computing some of the roots with multiplications keeps the other units busy.
[[gnu::always_inline]] inline double by_root(double x) {
  auto y = portable::bit_cast<double>(0x5FE6EB50C7B537A9ull - (portable::bit_cast<std::uint64_t>(x) >> 1));
  const double half = 0.5 * x;
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) y *= 1.5 - half * y * y;
  return y;
}
enum class Root { unit, newton };
template <Root how>
[[gnu::always_inline]] inline double root_of(double x) {
  return how == Root::newton ? x * by_root(x) : std::sqrt(x);
}

/// State of the mean for the circle at one end of a sheet, or for a loop. All variables of the mean are
/// doubled in each pass, as in Bulirsch's algorithm. Bulirsch's p is here u / v, and his c and s are c / v
/// and s / v, so that one division at the end is sufficient.
struct Rim {
  Column by_root;  ///< 1 / sqrt(zeta^2 + (a + rho)^2)
  Column kc, m, b, rest, c, s, u, v;
};

/// One tile of points. All values are per A (loop) or per A/m (sheet), without mu0.
struct alignas(64) Tile {
  Column by_sum;  ///< 1 / (a + rho)
  Rim upper, lower;
  std::size_t size = 0;  ///< number of points, a multiple of the vector length
  const double *rho = nullptr, *z = nullptr;
  double *b_rho = nullptr, *b_z = nullptr;  ///< results are added to these
  double factor = 0;                        ///< mu0 times the current
};

/// The circle of a rim, and the square of the smallest distance from it.
struct Circle {
  double a, wire2;
};

/// Modulus and first pass. `third`: for C(kc, g^2, 1, g) as well.
template <bool third, Root how>
[[gnu::always_inline]] inline void begin(const Circle& circle, double rho, double zeta, double g, Rim& r,
                                         std::size_t i) {
  const double a = circle.a, near2 = zeta * zeta + (a - rho) * (a - rho);
  const double by = by_root(zeta * zeta + (a + rho) * (a + rho));
  const double kc = std::sqrt(near2 < circle.wire2 ? circle.wire2 : near2) * by;
  r.by_root[i] = by;
  r.kc[i] = kc;
  if constexpr (third) {  // on the sheet, g = 0, p is 1 and C is K, the mean of both sides
    const double u = g == 0 ? 1.0 : std::fabs(g), s = g < 0 ? -1.0 : 1.0;
    r.c[i] = u + s;
    r.s[i] = 2 * (s * u + kc);
    r.u[i] = u * u + kc;
    r.v[i] = u;
  }
  r.m[i] = 1 + kc;
  r.b[i] = 2 * root_of<how>(kc);
  r.rest[i] = 0;
}

/// Updates p, c and s in a pass.
[[gnu::always_inline]] inline void turn(Rim& r, std::size_t i, double product) {
  const double c = r.c[i], s = r.s[i], u = r.u[i], v = r.v[i], qv = product * v;
  r.c[i] = c * u + s * v;
  r.s[i] = 2 * (s * u + c * qv);
  r.u[i] = u * u + qv * v;
  r.v[i] = u * v;
}

template <bool third, Root how>
[[gnu::always_inline]] inline void pass(Rim& r, std::size_t i, double weight) {
  const double m = r.m[i], b = r.b[i], product = m * b;
  if constexpr (third) turn(r, i, product);
  r.rest[i] += weight * (m - b) * (m - b);
  r.m[i] = m + b;
  r.b[i] = 2 * root_of<how>(product);
}

/// K(k), and K T with T = S / k^2, S = sum over n >= 1 of 2^n c_n^2 of the mean's differences c_n. Then
///   E = K (1 - k^2/2) - K T k^2/2,  C(kc,1,1,-1) = -K T,  C(kc,1,1,-kc^2) = K k^2/2 - K T (1 - k^2/2),
/// without the cancellation that K and E suffer near the axis.
struct Integrals {
  double k, kt;
  double p;  ///< C(kc, g^2, 1, g)
};

/// The last pass and the integrals; `k` is not computed together with the third.
template <bool third>
[[gnu::always_inline]] inline Integrals end(Rim& r, std::size_t i, double k2, double weight, double growth) {
  const double b = r.b[i], product = r.m[i] * b, difference = r.m[i] - b, m = r.m[i] + b;
  if constexpr (third) turn(r, i, product);
  const double rest = r.rest[i] + weight * difference * difference;
  // The mean is now (m + 2 root)/2 up to the square of the remaining difference. With Heron's root of the
  // product, m/4 + product/m, it is mean / m.
  const double mean = 0.75 * m * m + product, kc1 = 1 + r.kc[i];
  // The first term of T, k^2 / 2 (1 + kc)^2, is exact. The other terms are differences of nearly equal
  // numbers near the axis, where they are below the rounding error of the first: k^2 / 128 of it squared.
  const bool near_axis = k2 < 1e-7;
  const double by = near_axis ? 1 : k2, first = kc1 * kc1, sum = third ? mean * r.v[i] + m * r.u[i] : 1;
  const double all = portable::kPi / 2 * m / (mean * sum * by * first);
  Integrals out;
  out.kt = growth * (0.5 * k2 * by + (near_axis ? 0 : rest) * first) * sum * all;
  out.k = third ? 0 : growth * by * first * all;
  out.p = third ? (r.s[i] * m + r.c[i] * mean) * by * first * all : 0;
  return out;
}

// Minimum of non-negative numbers as bits, whose order is the same: this minimum vectorises.
[[gnu::always_inline]] inline std::uint64_t lesser(std::uint64_t bits, double x) {
  const auto other = portable::bit_cast<std::uint64_t>(x);
  return other < bits ? other : bits;
}

FABA_VECTORISED double begin_sheet(const Circle& circle, double half, Tile& t) {
  auto least = portable::bit_cast<std::uint64_t>(1.0);
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) {
    const double rho = t.rho[i];
    t.by_sum[i] = 1 / (circle.a + rho);
    const double g = (circle.a - rho) * t.by_sum[i];
    begin<true, Root::newton>(circle, rho, t.z[i] + half, g, t.upper, i);
    begin<true, Root::unit>(circle, rho, t.z[i] - half, g, t.lower, i);
    least = lesser(lesser(least, t.upper.kc[i]), t.lower.kc[i]);
  }
  return portable::bit_cast<double>(least);
}
FABA_VECTORISED void pass_sheet(double weight, Tile& t) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) {
    pass<true, Root::newton>(t.upper, i, weight);
    pass<true, Root::unit>(t.lower, i, weight);
  }
}
FABA_VECTORISED void end_sheet(const Circle& circle, double half, double weight, double growth, Tile& t) {
  const double a = circle.a, factor = t.factor * a / portable::kPi;
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) {
    const double u = t.upper.by_root[i], v = t.lower.by_root[i], four = 4 * a * t.rho[i];
    const Integrals up = end<true>(t.upper, i, four * (u * u), weight, growth),
                    low = end<true>(t.lower, i, four * (v * v), weight, growth);
    t.b_rho[i] += factor * (v * low.kt - u * up.kt);
    t.b_z[i] += factor * t.by_sum[i] * ((t.z[i] + half) * u * up.p - (t.z[i] - half) * v * low.p);
  }
}

FABA_VECTORISED double begin_loop(const Circle& circle, Tile& t) {
  auto least = portable::bit_cast<std::uint64_t>(1.0);
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) {
    begin<false, Root::newton>(circle, t.rho[i], t.z[i], 0, t.upper, i);
    least = lesser(least, t.upper.kc[i]);
  }
  return portable::bit_cast<double>(least);
}
FABA_VECTORISED void pass_loop(double weight, Tile& t) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) pass<false, Root::unit>(t.upper, i, weight);
}
FABA_VECTORISED void end_loop(const Circle& circle, double weight, double growth, Tile& t) {
  const double a = circle.a, factor = t.factor / portable::kPi;
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < t.size; ++i) {
    const double rho = t.rho[i], z = t.z[i], by = t.upper.by_root[i], kc = t.upper.kc[i];
    const double k2 = 4 * a * rho * (by * by), by_near = by * by / (kc * kc);
    const Integrals s = end<false>(t.upper, i, k2, weight, growth);
    const double e = s.k * (1 - 0.5 * k2) - s.kt * (0.5 * k2), c = s.k * (0.5 * k2) - s.kt * (1 - 0.5 * k2);
    t.b_z[i] += 0.5 * factor * (s.k + (a * a - rho * rho - z * z) * by_near * e) * by;
    t.b_rho[i] += factor * a * z * by_near * by * c;
  }
}

/// Number of passes for which K, T and the third integral are exact to 1e-14 for all g (checked with 45
/// digits).
int passes(double smallest_kc) {
  return smallest_kc > 0.975  ? 2
         : smallest_kc > 0.5  ? 3
         : smallest_kc > 0.06 ? 4
         : smallest_kc > 1e-3 ? 5
         : smallest_kc > 1e-6 ? 6
                              : 8;
}

// All passes except the first, which is part of begin(), and the last, which is part of end().
template <class Pass, class End>
void finish(double smallest_kc, Pass&& pass, End&& end) {
  double weight = 0.25;
  const int n = passes(smallest_kc);
  for (int i = 2; i < n; ++i, weight *= 0.5) pass(weight);
  end(weight, double(1 << n));
}

// Complete tiles are processed in place; the last one is padded with copies of its first point.
template <class Compute>
void for_tiles(const Places& at, const Components& b, double factor, Compute&& compute) {
  Tile tile;
  tile.factor = factor;
  const std::size_t points = at.rho.size(), complete = points / kTile * kTile;
  tile.size = kTile;
  for (std::size_t i = 0; i < complete; i += kTile) {
    tile.rho = &at.rho[i];
    tile.z = &at.z[i];
    tile.b_rho = &b.rho[i];
    tile.b_z = &b.z[i];
    compute(tile);
  }
  if (complete == points) return;
  constexpr std::size_t kVector = 16;
  const std::size_t n = points - complete;
  std::array<double, kTile> rho, z, b_rho{}, b_z{};
  tile.size = (n + kVector - 1) / kVector * kVector;
  for (std::size_t i = 0; i < tile.size; ++i) {
    rho[i] = at.rho[complete + (i < n ? i : 0)];
    z[i] = at.z[complete + (i < n ? i : 0)];
  }
  tile.rho = rho.data();
  tile.z = z.data();
  tile.b_rho = b_rho.data();
  tile.b_z = b_z.data();
  compute(tile);
  for (std::size_t i = 0; i < n; ++i) {
    b.rho[complete + i] += b_rho[i];
    b.z[complete + i] += b_z[i];
  }
}

}  // namespace

void add_loop(double a, double wire_radius, double current, const Places& at, const Components& b) {
  const Circle circle{a, wire_radius * wire_radius};
  for_tiles(at, b, kMu0 * current, [&](Tile& tile) {
    finish(
        begin_loop(circle, tile), [&](double weight) { pass_loop(weight, tile); },
        [&](double weight, double growth) { end_loop(circle, weight, growth, tile); });
  });
}

void add_sheet(double a, double half, double wire_radius, double sheet, const Places& at,
               const Components& b) {
  const Circle circle{a, wire_radius * wire_radius};
  for_tiles(at, b, kMu0 * sheet, [&](Tile& tile) {
    finish(
        begin_sheet(circle, half, tile), [&](double weight) { pass_sheet(weight, tile); },
        [&](double weight, double growth) { end_sheet(circle, half, weight, growth, tile); });
  });
}

}  // namespace faba::axial
