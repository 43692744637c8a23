#include "study/flow/flow_check.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "vision/image/picture_noise.h"

using namespace faba;

namespace {

constexpr int kWidth = 96, kHeight = 72;

/// A smooth pattern moved by `dx` px, with noise; `lines`: it changes along x only.
GrayF pattern(double dx, double noise, unsigned seed, bool lines = false, double gain = 1) {
  std::mt19937 g(seed);
  std::normal_distribution<double> gauss(0, 1);
  GrayF p(kWidth, kHeight);
  for (int r = 0; r < kHeight; ++r)
    for (int c = 0; c < kWidth; ++c)
      p.at(c, r) = float(gain * (128 + 30 * std::sin((c - dx) / 4.0) * (lines ? 1 : std::cos(r / 5.0))) +
                         noise * gauss(g));
  return p;
}

Flow uniform(double u) { return {GrayF(kWidth, kHeight, float(u)), GrayF(kWidth, kHeight, 0)}; }

std::vector<Warning> checked(const GrayF& a, const GrayF& b, double u) {
  FlowCheck check;
  check.add(a, b, uniform(u));
  return check.warnings(std::fabs(u));
}

bool warns(const std::vector<Warning>& all, const char* aspect) {
  return std::any_of(all.begin(), all.end(), [&](const Warning& w) { return w.aspect == aspect; });
}

}  // namespace

TEST_CASE("the noise of a picture does not depend on its smooth structure") {
  // Standard error of a median deviation of n values: 1.17 / sqrt(n); four of them.
  for (const double sd : {1.0, 5.0})
    CHECK(picture_noise(pattern(0, sd, 1)) == doctest::Approx(sd).epsilon(0.08));
}

TEST_CASE(
    "a flow that is right has no warning; one with half of the displacement is doubtful, none is poor") {
  const GrayF a = pattern(0, 1, 1), b = pattern(1.5, 1, 2);
  CHECK(checked(a, b, 1.5).empty());
  CHECK(warns(checked(a, b, 0.9), "displacement"));
  CHECK(quality_of(checked(a, b, 0)) == Quality::poor);
}

TEST_CASE("noise, changes of the light and lines in one direction are named") {
  CHECK(quality_of(checked(pattern(0, 8, 1), pattern(0.05, 8, 2), 0.05)) == Quality::poor);
  CHECK(warns(checked(pattern(0, 8, 1), pattern(0.05, 8, 2), 0.05), "noise"));
  CHECK(warns(checked(pattern(0, 1, 1), pattern(0, 1, 2, false, 1.05), 0), "light"));
  CHECK(warns(checked(pattern(0, 1, 1, true), pattern(1, 1, 2, true), 1), "aperture"));
}

TEST_CASE("equal pictures have neither difference nor warning") {
  const GrayF a = pattern(0, 1, 1);
  FlowCheck check;
  check.add(a, a, uniform(0));
  CHECK(!check.unexplained());
  CHECK(check.warnings(0).empty());
}
