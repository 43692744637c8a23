// Measures ns per point of the field of one solenoid, compared with the same formula with the Carlson
// integrals of Boost.Math. Prints JSON lines for coils.py. With a file name, writes points and fields there
// as raw doubles (all rho, z, b_rho, b_z), as reference for other programs.
#include <fmt/format.h>

#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/threads/parallel.h"
#include "field/kernels/axial.h"
#include "machine.h"
#include "timing.h"

namespace faba::bench {
namespace {

constexpr double kRadius = 0.005, kHalf = 0.02, kSheet = 5000, kPi = 3.14159265358979323846;
constexpr std::size_t kPoints = 100000, kBoostPoints = 5000;

struct Coil {
  std::vector<double> rho, z, b_rho, b_z;
  explicit Coil(std::size_t n) : rho(n), z(n), b_rho(n), b_z(n) {
    // A golden-ratio lattice over rho < 4 a and |z| < 2 b: all points are different, none is on the sheet.
    for (std::size_t i = 0; i < n; ++i) {
      rho[i] = 4 * kRadius * (double(i) + 0.5) / double(n);
      z[i] = 2 * kHalf * (2 * std::fmod(double(i) * 0.61803398874989485, 1.0) - 1);
    }
  }
};

// C(kc, p, c, s) = c R_F(0, kc^2, 1) + (s - p c) / 3 R_J(0, kc^2, 1, p)  (theory C1)
void carlson(Coil& c, std::size_t n) {
  using namespace boost::math;
  for (std::size_t i = 0; i < n; ++i) {
    const double rho = c.rho[i], g = (kRadius - rho) / (kRadius + rho);
    double b_rho = 0, b_z = 0;
    for (const double side : {1.0, -1.0}) {
      const double zeta = c.z[i] + side * kHalf, x = zeta * zeta + (kRadius + rho) * (kRadius + rho);
      const double kc2 = (zeta * zeta + (kRadius - rho) * (kRadius - rho)) / x;
      const double rf = ellint_rf(0.0, kc2, 1.0);
      b_rho += side * kRadius / std::sqrt(x) * (rf - 2.0 / 3 * ellint_rd(0.0, kc2, 1.0));
      b_z += side * zeta / std::sqrt(x) * (rf + (g - g * g) / 3 * ellint_rj(0.0, kc2, 1.0, g * g));
    }
    c.b_rho[i] = axial::kMu0 * kSheet / kPi * b_rho;
    c.b_z[i] = axial::kMu0 * kSheet / kPi * kRadius / (kRadius + rho) * b_z;
  }
}

void ours(Coil& c, Pool& pool) {
  pool.for_blocks(c.rho.size(), 4096, [&](std::size_t begin, std::size_t end) {
    const auto part = [&](std::vector<double>& v) { return std::span(v).subspan(begin, end - begin); };
    std::fill(part(c.b_rho).begin(), part(c.b_rho).end(), 0.0);
    std::fill(part(c.b_z).begin(), part(c.b_z).end(), 0.0);
    axial::add_sheet(kRadius, kHalf, 1e-6, kSheet, {part(c.rho), part(c.z)}, {part(c.b_rho), part(c.b_z)});
  });
}

void print(const std::string& what, unsigned threads, std::size_t points, const std::vector<double>& ns,
           double error) {
  const Spread s = spread(ns);
  const nlohmann::ordered_json j{
      {"kind", what},    {"threads", threads}, {"points", points},         {"ns", s.median},
      {"ns_low", s.low}, {"ns_high", s.high},  {"vectors", vector_unit()}, {"worst_error", error}};
  fmt::print("{}\n", j.dump());
}

int measure(const char* file) {
  Pool one(1), two(2);
  Coil a(kPoints), b(kPoints), boost(kPoints);
  std::vector<Timed> all{{[] {}, [&] { ours(a, one); }, double(kPoints)},
                         {[] {}, [&] { ours(b, two); }, double(kPoints)},
                         {[] {}, [&] { carlson(boost, kBoostPoints); }, double(kBoostPoints)}};
  time_in_turns(all, 15, 4);
  carlson(boost, kPoints);
  double error = 0;
  bool same = true;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double size = std::hypot(boost.b_rho[i], boost.b_z[i]);
    error = std::max(error, std::hypot(a.b_rho[i] - boost.b_rho[i], a.b_z[i] - boost.b_z[i]) / size);
    same = same && a.b_rho[i] == b.b_rho[i] && a.b_z[i] == b.b_z[i];
  }
  print("faba", 1, kPoints, all[0].ns, error);
  print("faba", 2, kPoints, all[1].ns, error);
  print("boost", 1, kBoostPoints, all[2].ns, 0);
  if (file) {
    std::ofstream out(file, std::ios::binary);
    for (const auto* v : {&a.rho, &a.z, &a.b_rho, &a.b_z})
      out.write(reinterpret_cast<const char*>(v->data()), std::streamsize(v->size() * sizeof(double)));
  }
  // Both have up to ten rounding errors per integral; Boost loses digits near the axis, where terms of B_rho
  // cancel.
  return same && error < 1e-11 ? 0 : 1;
}

}  // namespace
}  // namespace faba::bench

int main(int argc, char** argv) { return faba::bench::measure(argc > 1 ? argv[1] : nullptr); }
