#include "core/random/philox.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace faba;

TEST_CASE("T13: Philox4x32-10 known answers (Random123)") {
  using Words = std::array<std::uint32_t, 4>;
  const auto cipher = [](Words c, std::uint32_t k0, std::uint32_t k1) {
    philox(c[0], c[1], c[2], c[3], k0, k1);
    return c;
  };
  CHECK(cipher({0, 0, 0, 0}, 0, 0) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(cipher({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u) == Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(cipher({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0) ==
        Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("draw() is Philox with counter (agent, step, stream, block)") {
  std::uint32_t c0 = 7, c1 = 11, c2 = 3, c3 = 2;
  philox(c0, c1, c2, c3, 0x89abcdef, 0x01234567);
  CHECK(draw(0x0123456789abcdefull, Stream::motility, 7, 11, 2) ==
        std::array<std::uint32_t, 4>{c0, c1, c2, c3});
}

TEST_CASE("uniform numbers are strictly between 0 and 1") {
  CHECK(uniform(0) > 0.0f);
  CHECK(uniform(~0u) < 1.0f);
}

TEST_CASE("normals: mean, variance, kurtosis and correlation of a million numbers") {
  const std::size_t n = 500000;
  double s1 = 0, s2 = 0, s4 = 0, cross = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto w = draw(1, Stream::motion, std::uint32_t(i), 0);
    const auto [a, b] = normals(w[0], w[1]);
    for (const double g : {double(a), double(b)}) {
      s1 += g;
      s2 += g * g;
      s4 += g * g * g * g;
    }
    cross += double(a) * double(b);
  }
  const double m = 2 * double(n);
  // standard errors of a standard normal's moments: 1, sqrt(2), sqrt(96), 1 over sqrt(m)
  CHECK(std::fabs(s1 / m) < 4 / std::sqrt(m));
  CHECK(std::fabs(s2 / m - 1) < 4 * std::sqrt(2 / m));
  CHECK(std::fabs(s4 / m - 3) < 4 * std::sqrt(96 / m));
  CHECK(std::fabs(cross / double(n)) < 4 / std::sqrt(double(n)));
}

TEST_CASE("below() is uniform over its range") {
  std::array<int, 17> count{};
  const int n = 170000;
  for (int i = 0; i < n; ++i) ++count[below(draw(3, Stream::start, std::uint32_t(i), 0)[0], 17)];
  double chi2 = 0;
  for (const int c : count) chi2 += (c - n / 17.0) * (c - n / 17.0) / (n / 17.0);
  CHECK(chi2 < 16 + 4 * std::sqrt(2.0 * 16));  // mean k, variance 2 k
}
