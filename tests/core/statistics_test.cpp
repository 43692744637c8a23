#include "core/statistics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/random/philox.h"

using namespace faba;

namespace {

std::vector<double> sample(std::size_t n, std::uint64_t seed) {
  std::vector<double> v(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto w = draw(seed, Stream::study, std::uint32_t(i), 0);
    // Only a few different values, so that ties occur.
    v[i] = double(w[0] % 17) - 8 + (w[1] % 3 == 0 ? 0.25 : 0);
  }
  return v;
}

template <class T>
std::vector<T> as(const std::vector<double>& v) {
  return {v.begin(), v.end()};
}

template <class T>
std::vector<T> sorted(std::vector<T> v) {
  std::sort(v.begin(), v.end());
  return v;
}

// Type 7 by its definition in Hyndman & Fan: with gamma the fraction of h, (1 - gamma) x_j + gamma x_(j+1).
template <class T>
double type_7(const std::vector<T>& values, double p) {
  const std::vector<T> x = sorted(values);
  const double h = p * double(x.size() - 1), j = std::floor(h);
  const std::size_t next = std::min(std::size_t(j) + 1, x.size() - 1);
  return (1 - (h - j)) * double(x[std::size_t(j)]) + (h - j) * double(x[next]);
}

template <class T>
void compare_with_sorting() {
  for (std::size_t n = 1; n <= 60; ++n) {
    const std::vector<T> v = as<T>(sample(n, n));
    const std::vector<T> x = sorted(v);
    for (const double p : {0.0, 0.001, 0.05, 0.1, 0.25, 1.0 / 3, 0.5, 0.75, 0.9, 0.95, 0.999, 1.0}) {
      CAPTURE(n);
      CAPTURE(p);
      CHECK(quantile(v, p) == doctest::Approx(type_7(v, p)).epsilon(1e-14));
      std::vector<T> work = v;
      CHECK(quantile_low(work, p) == x[std::size_t(std::floor(p * double(n - 1)))]);
      CHECK(sorted(work) == x);
      CHECK(quantile_nearest(work, p) == x[std::size_t(std::floor(p * double(n - 1) + 0.5))]);
    }
    CHECK(median(v) == (double(x[(n - 1) / 2]) + double(x[n / 2])) / 2);
    std::vector<T> work = v;
    CHECK(median_low(work) == x[(n - 1) / 2]);
    work = v;
    CHECK(median_high(work) == x[n / 2]);
    for (std::size_t k = 0; k < n; ++k) {
      work = v;
      CHECK(order_statistic(work, k) == x[k]);
    }
  }
}

}  // namespace

// Values of which a sample is taken first: random, with ties, sorted, and periodic like the sample.
TEST_CASE_TEMPLATE("order statistics of many values are those of sorting", T, float, double) {
  constexpr std::size_t kMany = 50000;
  std::vector<T> random(kMany), rising(kMany), periodic(kMany), equal(kMany, T(3));
  for (std::size_t i = 0; i < kMany; ++i) {
    const auto w = draw(7, Stream::study, std::uint32_t(i), 0);
    random[i] = T(w[0]) - T(w[1]) / 2;
    rising[i] = T(i);
    periodic[i] = i * 1024 % kMany < 1024 ? T(-1) : T(w[0] % 1000);
  }
  for (const std::vector<T>& v : {random, rising, periodic, equal, as<T>(sample(kMany, 3))}) {
    const std::vector<T> x = sorted(v);
    for (const std::size_t k : {std::size_t(0), std::size_t(1), kMany / 1000, kMany / 4, (kMany - 1) / 2,
                                kMany / 2, kMany - 2, kMany - 1}) {
      CAPTURE(k);
      std::vector<T> work = v;
      CHECK(order_statistic(work, k) == x[k]);
      CHECK(sorted(work) == x);
    }
  }
}

TEST_CASE("Quantiles and order statistics agree with those of the sorted values") {
  compare_with_sorting<double>();
  compare_with_sorting<float>();
}

TEST_CASE("Quantiles agree with numpy.quantile(v, p)") {
  const std::vector<double> v{3, 1, 4, 1, 5, 9, 2, 6};
  CHECK(quantile(v, 0.1) == doctest::Approx(1).epsilon(1e-15));
  CHECK(quantile(v, 0.25) == doctest::Approx(1.75).epsilon(1e-15));
  CHECK(quantile(v, 0.5) == doctest::Approx(3.5).epsilon(1e-15));
  CHECK(quantile(v, 0.9) == doctest::Approx(6.9).epsilon(1e-15));
  CHECK(quantile(v, 0.95) == doctest::Approx(7.95).epsilon(1e-15));
  CHECK(v == std::vector<double>{3, 1, 4, 1, 5, 9, 2, 6});  // the input is not reordered
}

TEST_CASE("Interpolation between two values; the ends are not interpolated") {
  CHECK(median(std::vector<double>{2, 1}) == 1.5);
  CHECK(quantile(std::vector<double>{2, 1}, 0) == 1);
  CHECK(quantile(std::vector<double>{2, 1}, 1) == 2);
  CHECK(quantile(std::vector<float>{7}, 0.3) == 7);
  // The mean of two floats need not be a float.
  CHECK(median(std::vector<float>{1, 1 + 0x1p-23F}) == 1 + 0x1p-24);
}

TEST_CASE("No values, NaN and infinity") {
  std::vector<double> none;
  std::vector<float> none_f;
  CHECK(std::isnan(quantile(none, 0.5)));
  CHECK(std::isnan(median(none)));
  CHECK(std::isnan(median_low(none)));
  CHECK(std::isnan(median_high(none)));
  CHECK(std::isnan(quantile_low(none, 0.9)));
  CHECK(std::isnan(order_statistic(none, 0)));
  CHECK(std::isnan(robust_spread(none).median));
  CHECK(std::isnan(robust_spread(none).sd));
  CHECK(std::isnan(robust_spread_low(none_f).median));
  CHECK(std::isnan(median_low(none_f)));
  CHECK(std::isnan(quantile(std::vector<double>{1, kNaN, 2}, 0)));
  CHECK(std::isnan(robust_spread(std::vector<double>{1, kNaN, 2}).sd));
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(median(std::vector<double>{inf, 1, 2}) == 2);
  CHECK(quantile(std::vector<double>{inf, 1}, 0) == 1);
  CHECK(median(std::vector<double>{inf, inf}) == inf);
}

TEST_CASE("A probability outside 0 to 1 is an error") {
  const std::vector<double> v{1, 2};
  CHECK_THROWS_AS((void)quantile(v, -0.01), Error);
  CHECK_THROWS_AS((void)quantile(v, 1.01), Error);
  CHECK_THROWS_AS((void)quantile(v, kNaN), Error);
}

TEST_CASE("The robust standard deviation is 1.4826 times the median absolute deviation") {
  // Deviations from the median 3.5: 0.5 2.5 0.5 2.5 1.5 5.5 1.5 2.5; their median is (1.5 + 2.5) / 2.
  const std::vector<double> v{3, 1, 4, 1, 5, 9, 2, 6};
  CHECK(robust_spread(v).median == 3.5);
  CHECK(robust_spread(v).sd == doctest::Approx(1.4826 * 2).epsilon(1e-15));
  // About the lower median 3: 0 2 1 2 2 6 1 3; the lower median of these is 2.
  std::vector<float> w = as<float>(v);
  const RobustSpread<float> s = robust_spread_low(w);
  CHECK(s.median == 3);
  CHECK(s.sd == 1.4826F * 2);
}

TEST_CASE("The robust standard deviation of Gaussian values is their standard deviation") {
  constexpr std::size_t kValues = 100000;
  std::vector<double> v;
  for (std::uint32_t i = 0; v.size() < kValues; ++i) {
    const auto w = draw(3, Stream::study, i, 0);
    for (const float z : normals(w[0], w[1])) v.push_back(5 + 2 * double(z));
  }
  const RobustSpread<double> s = robust_spread(v);
  const double n = double(kValues);
  // Asymptotic standard errors: of the median sd sqrt(pi / 2 / n), of 1.4826 MAD sd 1.1664 / sqrt(n).
  CHECK(std::fabs(s.median - 5) < 4 * 2 * std::sqrt(1.5708 / n));
  CHECK(std::fabs(s.sd - 2) < 4 * 2 * 1.1664 / std::sqrt(n));
}
