// Theory A22: the published iteration against a pixel-by-pixel reference implementation, the multigrid
// solution against the equations, and derived properties.
#include "vision/flow/horn_schunck.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "vision/flow/warp.h"

using namespace faba;

namespace {

/// An infinite texture shifted by (dx, dy): a sum of sines in several directions.
template <class T>
Plane<T> texture(int width, int height, double dx, double dy) {
  Plane<T> p(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const double x = c - dx, y = r - dy;
      p.row(r)[c] = T(128 + 40 * std::sin(0.31 * x + 0.11 * y) + 35 * std::sin(0.27 * y - 0.08 * x) +
                      20 * std::sin(0.45 * (x + y)));
    }
  return p;
}

/// Reference implementation of the published algorithm (Horn & Schunck 1981, as corrected in A22), pixel by
/// pixel.
struct Slow {
  int w, h;
  std::vector<double> ix, iy, it, u, v;
  Slow(const Plane<double>& a, const Plane<double>& b, double alpha2, int sweeps)
      : w(a.width()), h(a.height()), ix(n()), iy(n()), it(n()), u(n()), v(n()) {
    const auto at = [&](const Plane<double>& p, int c, int r) {
      return p.row(std::clamp(r, 0, h - 1))[std::clamp(c, 0, w - 1)];
    };
    for (int r = 0; r < h; ++r)
      for (int c = 0; c < w; ++c) {
        const std::size_t i = index(c, r);
        for (const auto* p : {&a, &b}) {
          ix[i] += (at(*p, c + 1, r) - at(*p, c, r) + at(*p, c + 1, r + 1) - at(*p, c, r + 1)) / 4;
          iy[i] += (at(*p, c, r + 1) - at(*p, c, r) + at(*p, c + 1, r + 1) - at(*p, c + 1, r)) / 4;
        }
        for (int k = 0; k < 4; ++k) it[i] += (at(b, c + k % 2, r + k / 2) - at(a, c + k % 2, r + k / 2)) / 4;
      }
    for (int k = 0; k < sweeps; ++k) {
      const std::vector<double> u0 = u, v0 = v;
      for (int r = 0; r < h; ++r)
        for (int c = 0; c < w; ++c) {
          const std::size_t i = index(c, r);
          const double um = mean(u0, c, r), vm = mean(v0, c, r);
          const double s = (ix[i] * um + iy[i] * vm + it[i]) / (alpha2 + ix[i] * ix[i] + iy[i] * iy[i]);
          u[i] = um - ix[i] * s;
          v[i] = vm - iy[i] * s;
        }
    }
  }
  std::size_t n() const { return std::size_t(w) * std::size_t(h); }
  std::size_t index(int c, int r) const { return std::size_t(r) * std::size_t(w) + std::size_t(c); }
  double mean(const std::vector<double>& p, int c, int r) const {
    const auto at = [&](int x, int y) { return p[index(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1))]; };
    return (at(c - 1, r) + at(c + 1, r) + at(c, r - 1) + at(c, r + 1)) / 6 +
           (at(c - 1, r - 1) + at(c + 1, r - 1) + at(c - 1, r + 1) + at(c + 1, r + 1)) / 12;
  }
};

double largest_difference(const FlowPlanes<double>& w, const Slow& s) {
  double most = 0;
  for (int r = 0; r < s.h; ++r)
    for (int c = 0; c < s.w; ++c)
      most = std::max({most, std::fabs(w.u.row(r)[c] - s.u[s.index(c, r)]),
                       std::fabs(w.v.row(r)[c] - s.v[s.index(c, r)])});
  return most;
}

HornSchunckParams jacobi(int sweeps) {
  HornSchunckParams p;
  p.solver = FlowSolver::jacobi;
  p.iterations = sweeps;
  p.tolerance = 0;
  return p;
}

}  // namespace

TEST_CASE("the published iteration, for sizes that are and are not multiples of vectors and strips") {
  Pool pool(1);
  for (const auto& [w, h] : {std::pair{16, 12}, {37, 50}, {1, 9}, {9, 1}, {2, 2}, {1, 1}, {70, 33}})
    for (const int sweeps : {1, 2, 9, 10, 11, 23}) {
      auto a = texture<double>(w, h, 0, 0), b = texture<double>(w, h, 0.6, -0.3);
      HornSchunck<double> fast(jacobi(sweeps), pool);
      // Rounding only: each sweep adds an error of about 2e-16 to values below 1.
      CHECK(largest_difference(fast.between(a, b), Slow(a, b, 100, sweeps)) < 1e-12);
      CHECK(fast.iterations() == sweeps);
    }
}

TEST_CASE(
    "float agrees with double within float precision, and the result does not depend on the number of "
    "threads") {
  const int w = 213, h = 160;
  Pool one(1), three(3);
  HornSchunck<float> f1(jacobi(100), one), f3(jacobi(100), three);
  HornSchunck<double> d(jacobi(100), one);
  auto a = texture<float>(w, h, 0, 0), b = texture<float>(w, h, 0.5, 0.2);
  auto precise_a = texture<double>(w, h, 0, 0), precise_b = texture<double>(w, h, 0.5, 0.2);
  const auto &p = f1.between(a, b), &q = f3.between(a, b);
  const auto& r = d.between(precise_a, precise_b);
  // Frames are rounded to 24 bits: 1.5e-5 of 255 grey levels, over gradients of 10 levels per px and more
  // where the flow is determined; 1e-4 px is a margin for the hundred sweeps.
  double off = 0;
  bool same = true;
  for (int row = 0; row < h; ++row)
    for (int c = 0; c < w; ++c) {
      off = std::max(off, std::fabs(double(p.u.row(row)[c]) - r.u.row(row)[c]));
      same = same && p.u.row(row)[c] == q.u.row(row)[c] && p.v.row(row)[c] == q.v.row(row)[c];
    }
  CHECK(off < 1e-4);
  CHECK(same);
}

TEST_CASE("multigrid converges to the same solution as Jacobi, for even and odd sizes") {
  Pool pool(2);
  for (const auto& [w, h] : {std::pair{64, 48}, {73, 49}, {37, 25}, {5, 3}, {17, 1}, {1, 1}}) {
    auto a = texture<double>(w, h, 0, 0), b = texture<double>(w, h, 0.6, -0.3);
    HornSchunckParams p;
    p.tolerance = 1e-9;
    HornSchunck<double> solver(p, pool);
    const auto& flow = solver.between(a, b);
    CHECK(solver.converged());
    CHECK(solver.iterations() < 60);
    // The change per Jacobi sweep is then below rounding.
    CHECK(largest_difference(flow, Slow(a, b, p.alpha2, 20000)) < 1e-7);
  }
}

TEST_CASE("the displacement of a texture is measured: half a pixel without pyramid, seven with pyramid") {
  const int w = 160, h = 120;
  Pool pool(2);
  const auto error_inside = [&](const HornSchunckParams& p, double dx, double dy) {
    HornSchunck<float> solver(p, pool);
    auto a = texture<float>(w, h, 0, 0), b = texture<float>(w, h, dx, dy);
    const auto& flow = solver.between(a, b);
    double sum = 0;
    int n = 0;
    for (int r = 12; r < h - 12; ++r)
      for (int c = 12; c < w - 12; ++c, ++n)
        sum += std::hypot(double(flow.u.row(r)[c]) - dx, double(flow.v.row(r)[c]) - dy);
    return sum / n;
  };
  HornSchunckParams plain, pyramid;
  pyramid.pyramid = true;
  // First differences over a step d of a wave of wavenumber k have a relative error of (k d)^2 / 24 of the
  // gradient, here k <= 0.64: below 1 % of half a pixel; smoothness has little effect on uniform motion.
  CHECK(error_inside(plain, 0.5, -0.25) < 0.01);
  CHECK(error_inside(plain, 7, -3) > 1);  // out of range without pyramid
  // The residual after warping is a shift far below a pixel and the error of cubic interpolation.
  CHECK(error_inside(pyramid, 7, -3) < 0.02);
}

TEST_CASE("a still scene, a black frame, and frames with NaN") {
  Pool pool(1);
  auto still = texture<float>(40, 30, 0, 0);
  for (const bool pyramid : {false, true}) {
    HornSchunckParams p;
    p.pyramid = pyramid;
    HornSchunck<float> solver(p, pool);
    Plane<float> black(40, 30);
    for (auto* frame : {&still, &black}) {
      const auto& flow = solver.between(*frame, *frame);
      for (int r = 0; r < 30; ++r)
        for (int c = 0; c < 40; ++c) {
          REQUIRE(flow.u.row(r)[c] == 0);
          REQUIRE(flow.v.row(r)[c] == 0);
        }
    }
  }
}

TEST_CASE("warping by the true displacement restores the first picture") {
  Pool pool(1);
  const int w = 50, h = 40;
  const auto a = texture<double>(w, h, 0, 0), b = texture<double>(w, h, 2.3, -1.6);
  FlowPlanes<double> flow;
  flow.resize(w, h);
  for (int r = 0; r < h; ++r)
    for (int c = 0; c < w; ++c) {
      flow.u.row(r)[c] = 2.3;
      flow.v.row(r)[c] = -1.6;
    }
  Plane<double> back;
  warp(b, flow, back, pool);
  // Cubic convolution has third-order error: (k h)^3 of the amplitude of each wave, k <= 0.64 over both
  // directions, with a constant below 1/10 (Keys 1981): half a grey level of 95.
  for (int r = 0; r < h; ++r)
    for (int c = 0; c < w; ++c) {
      const bool inside = c + 2.3 <= w - 1 && r - 1.6 >= 0;
      CHECK(std::isfinite(back.row(r)[c]) == inside);
      if (inside && c < w - 5 && r > 4) CHECK(std::fabs(back.row(r)[c] - a.row(r)[c]) < 0.5);
    }
}
