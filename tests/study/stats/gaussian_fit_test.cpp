#include "study/stats/gaussian_fit.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace faba;

namespace {

struct Series {
  std::vector<double> t, y;
};
Series peak(double a, double mu, double s, double c, double noise, unsigned seed, int n = 90) {
  std::mt19937 g(seed);
  std::normal_distribution<double> gauss(0, noise);
  Series out;
  for (int i = 0; i < n; ++i) {
    const double t = i / 15.0, z = (t - mu) / s;
    out.t.push_back(t);
    out.y.push_back(std::max(a * std::exp(-z * z / 2) + c + (noise > 0 ? gauss(g) : 0), 0.0));
  }
  return out;
}

}  // namespace

TEST_CASE("the parameters of a Gaussian without noise are recovered") {
  const Series s = peak(1.7e4, 2.2, 0.8, 8.3e3, 0, 1);
  const GaussianFit f = fit_gaussian(s.t, s.y);
  CHECK(f.good);
  CHECK(f.amplitude == doctest::Approx(1.7e4).epsilon(1e-6));
  CHECK(f.peak_s == doctest::Approx(2.2).epsilon(1e-6));
  CHECK(f.sigma_s == doctest::Approx(0.8).epsilon(1e-6));
  CHECK(f.offset == doctest::Approx(8.3e3).epsilon(1e-6));
}

TEST_CASE("standard errors equal the scatter of the estimates over many series") {
  double sum = 0, squares = 0, stated = 0;
  const int n = 200;
  for (unsigned seed = 1; seed <= n; ++seed) {
    const Series s = peak(100, 3, 0.7, 40, 12, seed);
    const GaussianFit f = fit_gaussian(s.t, s.y);
    REQUIRE(f.good);
    sum += f.peak_s - 3;
    squares += (f.peak_s - 3) * (f.peak_s - 3);
    stated += f.se_peak_s / n;
  }
  const double sd = std::sqrt(squares / n);
  CHECK(std::fabs(sum / n) < 4 * sd / std::sqrt(n));
  // The relative error of a standard deviation from 200 values is 5 %; the correction for correlation only
  // increases the standard errors.
  CHECK(stated > 0.8 * sd);
  CHECK(stated < 1.4 * sd);
}

TEST_CASE("series without a peak are not accepted") {
  int good = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Series flat = peak(0, 3, 1, 8.3e3, 300, seed);
    good += fit_gaussian(flat.t, flat.y).good;
  }
  CHECK(good == 0);  // probability 1e-4 each
  const Series rising = peak(100, 30, 8, 10, 1, 1);
  CHECK_FALSE(fit_gaussian(rising.t, rising.y).good);
  const std::vector<double> t{0, 1, 2, 3, 4, 5, 6}, same(7, 3.0), zero(7, 0.0);
  CHECK(fit_gaussian({t.data(), 3}, {same.data(), 3}).reason == "3 pairs of frames, at least 6 are needed");
  CHECK_FALSE(fit_gaussian(t, same).good);
  CHECK_FALSE(fit_gaussian(t, zero).good);
  CHECK_FALSE(fit_gaussian(std::vector<double>{1, 2}, std::vector<double>{1, 2}).good);
  CHECK_FALSE(fit_gaussian({}, {}).good);
}
