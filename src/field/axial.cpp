#include "field/axial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/portable_math.h"
#include "core/vectorised.h"

namespace faba::axial {
namespace {

// Complete elliptic integrals by the arithmetic-geometric mean, Bulirsch's cel (theory C1), with a fixed
// number of passes so that loops over points vectorise. Convergence is quadratic: the number follows from the
// smallest complementary modulus kc among the points of a tile.
constexpr std::size_t kTile = 128;

/// K(k), and T = S / k^2 with S = sum over n >= 1 of 2^n c_n^2 of the mean's differences c_n. Then
///   E = K (1 - (k^2 + S) / 2),  C(kc,1,1,-1) = -K T,  C(kc,1,1,-kc^2) = K (k^2/2 - T (1 - k^2/2)),
/// without the cancellation that K and E suffer near the axis.
struct Sums {
  double k, t;
  double p;  ///< C(kc, g^2, 1, g)
};

/// `g` only matters to p; `third` says whether p is wanted at all. All variables of the mean grow by 2 from
/// pass to pass, as in Bulirsch's algorithm.
template <int Passes, bool third>
[[gnu::always_inline]] inline Sums sums(double kc, double k2, double g) {
  double m = 1, b = kc, product = kc, weight = 0.5, rest = 0;
  double c = 1, s = g < 0 ? -1.0 : 1.0, p = std::fabs(g);
  p = g == 0 ? 1.0 : p;  // on the sheet: the mean of both sides is K
#pragma GCC unroll 8
  for (int n = 0; n < Passes; ++n) {
    if (n > 0) rest += weight * (m - b) * (m - b);
    weight *= 0.5;
    if constexpr (third) {
      const double by_p = 1 / p, ratio = product * by_p, f = c;
      c += s * by_p;
      s = 2 * (s + f * ratio);
      p += ratio;
    }
    const double root = std::sqrt(product);
    m += b;
    b = 2 * root;
    product = b * m;
  }
  // The first term of T is exact. The others are differences of nearly equal numbers near the axis, where
  // they are less than the last digit of the first: k^2 / 128 of it squared.
  const double first = 1 / (1 + kc);
  const bool near_axis = k2 < 1e-7;
  Sums out;
  out.t = 0.5 * k2 * first * first + (near_axis ? 0 : rest / (near_axis ? 1 : k2));
  // Half the sum is the mean to the square of the difference that is left; m alone would be off by the
  // difference.
  m = 0.5 * (m + b);
  const double last = portable::kPi / 2 / (third ? m * (m + p) : m);
  out.k = double(1 << Passes) * (third ? (m + p) * last : last);
  out.p = third ? (s + c * m) * last : 0;
  return out;
}

/// One tile of points. Everything per A (loop) or per A/m (sheet), without mu0.
struct Tile {
  std::size_t size = 0;  ///< whole vectors of them, the last ones copies of the first point
  std::array<double, kTile> rho, z, b_rho, b_z;
};

/// What the integrals need for a rim of radius a at the distance zeta along the axis.
struct Modulus {
  double by_root;  ///< 1 / sqrt(zeta^2 + (a + rho)^2)
  double kc, k2;
};
[[gnu::always_inline]] inline Modulus modulus(double a, double rho, double zeta, double wire2) {
  const double near2 = zeta * zeta + (a - rho) * (a - rho);
  Modulus o;
  o.by_root = 1 / std::sqrt(zeta * zeta + (a + rho) * (a + rho));
  o.kc = std::sqrt(near2 < wire2 ? wire2 : near2) * o.by_root;
  o.k2 = 4 * a * rho * (o.by_root * o.by_root);
  return o;
}

template <int Passes>
[[gnu::always_inline]] inline void loop_tile(double a, double wire2, Tile& tile) {
  for (std::size_t i = 0; i < tile.size; ++i) {
    const double rho = tile.rho[i], z = tile.z[i];
    const Modulus o = modulus(a, rho, z, wire2);
    const Sums s = sums<Passes, false>(o.kc, o.k2, 0);
    const double by_near = o.by_root * o.by_root / (o.kc * o.kc);
    const double e = s.k * (1 - 0.5 * o.k2 * (1 + s.t));
    const double c = s.k * (0.5 * o.k2 - s.t * (1 - 0.5 * o.k2));
    tile.b_z[i] = (s.k + (a * a - rho * rho - z * z) * by_near * e) * o.by_root / (2 * portable::kPi);
    tile.b_rho[i] = a * z * by_near * o.by_root * c / portable::kPi;
  }
}

template <int Passes>
[[gnu::always_inline]] inline void sheet_tile(double a, double half, double wire2, Tile& tile) {
  for (std::size_t i = 0; i < tile.size; ++i) {
    const double rho = tile.rho[i], above = tile.z[i] + half, below = tile.z[i] - half;
    const double by_sum = 1 / (a + rho), g = (a - rho) * by_sum;
    const Modulus u = modulus(a, rho, above, wire2), v = modulus(a, rho, below, wire2);
    const Sums su = sums<Passes, true>(u.kc, u.k2, g), sv = sums<Passes, true>(v.kc, v.k2, g);
    tile.b_rho[i] = (a / portable::kPi) * (v.by_root * sv.k * sv.t - u.by_root * su.k * su.t);
    tile.b_z[i] = (a / portable::kPi) * by_sum * (above * u.by_root * su.p - below * v.by_root * sv.p);
  }
}

#define FABA_PASSES(N)                                                                                \
  FABA_VECTORISED void loop_##N(double a, double wire2, Tile& tile) { loop_tile<N>(a, wire2, tile); } \
  FABA_VECTORISED void sheet_##N(double a, double half, double wire2, Tile& tile) {                   \
    sheet_tile<N>(a, half, wire2, tile);                                                              \
  }
FABA_PASSES(4)
FABA_PASSES(5)
FABA_PASSES(6)
FABA_PASSES(8)
#undef FABA_PASSES

/// Passes until the mean's two sides agree to 1e-8, which makes the integrals exact to 1e-16.
int passes(double smallest_kc) {
  return smallest_kc > 0.06 ? 4 : smallest_kc > 3e-3 ? 5 : smallest_kc > 1e-6 ? 6 : 8;
}

FABA_VECTORISED double smallest_kc2(double a, double half, double wire2, const Tile& tile) {
  double least = 1;
  for (std::size_t i = 0; i < tile.size; ++i) {
    const double z = std::fabs(tile.z[i]) - half, rho = tile.rho[i];
    const double near2 = z * z + (a - rho) * (a - rho),
                 kc2 = (near2 < wire2 ? wire2 : near2) / (z * z + (a + rho) * (a + rho));
    least = kc2 < least ? kc2 : least;
  }
  return least;
}

template <class Compute>
void for_tiles(const Places& at, const Components& b, double factor, Compute&& compute) {
  Tile tile;
  for (std::size_t begin = 0; begin < at.rho.size(); begin += kTile) {
    const std::size_t n = std::min(kTile, at.rho.size() - begin);
    constexpr std::size_t kVector = 16;
    tile.size = (n + kVector - 1) / kVector * kVector;
    for (std::size_t i = 0; i < tile.size; ++i) {  // a last tile is filled with copies of its first point
      tile.rho[i] = at.rho[begin + (i < n ? i : 0)];
      tile.z[i] = at.z[begin + (i < n ? i : 0)];
    }
    compute(tile);
    for (std::size_t i = 0; i < n; ++i) {
      b.rho[begin + i] += factor * tile.b_rho[i];
      b.z[begin + i] += factor * tile.b_z[i];
    }
  }
}

}  // namespace

void add_loop(double a, double wire_radius, double current, const Places& at, const Components& b) {
  const double wire2 = wire_radius * wire_radius;
  for_tiles(at, b, kMu0 * current, [&](Tile& tile) {
    switch (passes(std::sqrt(smallest_kc2(a, 0, wire2, tile)))) {
      case 4:
        return loop_4(a, wire2, tile);
      case 5:
        return loop_5(a, wire2, tile);
      case 6:
        return loop_6(a, wire2, tile);
      default:
        return loop_8(a, wire2, tile);
    }
  });
}

void add_sheet(double a, double half, double wire_radius, double sheet, const Places& at,
               const Components& b) {
  const double wire2 = wire_radius * wire_radius;
  for_tiles(at, b, kMu0 * sheet, [&](Tile& tile) {
    switch (passes(std::sqrt(smallest_kc2(a, half, wire2, tile)))) {
      case 4:
        return sheet_4(a, half, wire2, tile);
      case 5:
        return sheet_5(a, half, wire2, tile);
      case 6:
        return sheet_6(a, half, wire2, tile);
      default:
        return sheet_8(a, half, wire2, tile);
    }
  });
}

}  // namespace faba::axial
