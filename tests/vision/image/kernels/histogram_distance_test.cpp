// Theory A18: the authors' test vector, identities that follow from the definition, and the definition as an
// explicit double sum.
#include "vision/image/kernels/histogram_distance.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/error.h"

using namespace faba;

namespace {

double qc(const std::vector<double>& p, const std::vector<double>& q, double m, double threshold) {
  return HistogramDistance(BinSimilarity::truncated_linear(threshold), m)(p, q);
}

double by_definition(const std::vector<double>& p, const std::vector<double>& q, double m, double threshold) {
  const auto n = int(p.size());
  const auto a = [&](int i, int j) { return std::max(0.0, 1 - std::abs(i - j) / threshold); };
  std::vector<double> d(p.size());
  for (int i = 0; i < n; ++i) {
    double z = 0;
    for (int c = 0; c < n; ++c) z += (p[std::size_t(c)] + q[std::size_t(c)]) * a(c, i);
    d[std::size_t(i)] = z > 0 ? (p[std::size_t(i)] - q[std::size_t(i)]) / std::pow(z, m) : 0;
  }
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += d[std::size_t(i)] * d[std::size_t(j)] * a(i, j);
  return std::sqrt(std::max(0.0, sum));
}

std::vector<double> random_histogram(std::mt19937& g, std::size_t n) {
  std::vector<double> h(n);
  for (double& x : h) x = g() % 3 ? std::ldexp(double(g()), int(g() % 60) - 50) : 0;
  return h;
}

}  // namespace

TEST_CASE("the test vector of A18") {
  const std::vector<double> p{1, 0, 2, 3, 0, 0}, q{0, 1, 2, 5, 0, 0};
  const double table[][4] = {{1, 2.449489742783, 1.581138830084, 1.447318999187},
                             {2, 2.236067977500, 0.957050245237, 0.652248645707},
                             {3, 2.449489742783, 0.837148187674, 0.403214730772}};
  // Twelve decimals are printed: tolerance is half of the last one.
  for (const auto& row : table) {
    CHECK(std::fabs(qc(p, q, 0, row[0]) - row[1]) < 5.1e-13);
    CHECK(std::fabs(qc(p, q, 0.5, row[0]) - row[2]) < 5.1e-13);
    CHECK(std::fabs(qc(p, q, 0.9, row[0]) - row[3]) < 5.1e-13);
  }
}

TEST_CASE("a moving peak of 10: the values of A18, constant beyond the threshold") {
  const double printed[][2] = {{1, 0.649068}, {2, 1.122082}, {3, 1.780389}, {8, 1.780389}};
  std::vector<double> p(30, 0.0);
  p[10] = 10;
  for (const auto& [shift, distance] : printed) {
    std::vector<double> q(30, 0.0);
    q[std::size_t(10 + shift)] = 10;
    CHECK(std::fabs(qc(p, q, 0.9, 3) - distance) < 5.1e-7);
  }
}

TEST_CASE("identities and the definition, over random histograms of many magnitudes") {
  std::mt19937 g(4);
  for (int i = 0; i < 60; ++i) {
    const std::size_t n = 1 + g() % 97;
    const auto p = random_histogram(g, n), q = random_histogram(g, n);
    const double m = double(g() % 1000) / 1000, threshold = 0.5 + double(g() % 400) / 10;
    const double d = qc(p, q, m, threshold);
    CHECK(d == doctest::Approx(by_definition(p, q, m, threshold)).epsilon(1e-12));
    CHECK(qc(p, p, m, threshold) == 0);
    CHECK(qc(q, p, m, threshold) == d);
    auto cp = p, cq = q;
    for (double& x : cp) x *= 37;
    for (double& x : cq) x *= 37;
    CHECK(qc(cp, cq, m, threshold) == doctest::Approx(std::pow(37, 1 - m) * d).epsilon(1e-12));
    double chi2 = 0;
    for (std::size_t k = 0; k < n; ++k)
      if (p[k] + q[k] > 0) chi2 += (p[k] - q[k]) * (p[k] - q[k]) / (p[k] + q[k]);
    const double half = qc(p, q, 0.5, 1);
    CHECK(half * half == doctest::Approx(chi2).epsilon(1e-12));
    // Empty bins on both sides, beyond the reach of the similarity, do not change the distance.
    auto longer_p = p, longer_q = q;
    longer_p.resize(n + 50, 0.0);
    longer_q.resize(n + 50, 0.0);
    CHECK(qc(longer_p, longer_q, m, threshold) == doctest::Approx(d).epsilon(1e-12));
  }
}

TEST_CASE("a given matrix gives the same result as the equivalent band") {
  std::mt19937 g(5);
  const std::size_t n = 12;
  const auto p = random_histogram(g, n), q = random_histogram(g, n);
  std::vector<double> a(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      a[i * n + j] = std::max(0.0, 1 - std::fabs(double(i) - double(j)) / 4.5);
  CHECK(HistogramDistance(BinSimilarity::given(a, n, "a"), 0.7)(p, q) ==
        doctest::Approx(qc(p, q, 0.7, 4.5)).epsilon(1e-12));
}

TEST_CASE("inputs for which the distance is undefined are refused") {
  const std::vector<double> p{1, 2}, negative{1, -2}, three{1, 2, 3}, nan{1, std::nan("")};
  CHECK_THROWS_AS(qc(p, p, 1, 3), Error);
  CHECK_THROWS_AS(qc(p, p, -0.1, 3), Error);
  CHECK_THROWS_AS(qc(p, p, std::nan(""), 3), Error);
  CHECK_THROWS_AS(qc(p, p, 0.9, 0), Error);
  CHECK_THROWS_AS(qc(p, p, 0.9, std::nan("")), Error);
  CHECK_THROWS_AS(qc(p, negative, 0.9, 3), Error);
  CHECK_THROWS_AS(qc(p, three, 0.9, 3), Error);
  CHECK_THROWS_AS(qc(nan, p, 0.9, 3), Error);
  CHECK_THROWS_AS(BinSimilarity::given({1, 2, 0, 1}, 2, "a"),
                  Error);  // more similar to another bin than to itself
  CHECK_THROWS_AS(BinSimilarity::given({1, -1, 0, 1}, 2, "a"), Error);  // negative similarity
  CHECK_THROWS_AS(BinSimilarity::given({1, 0, 1}, 2, "a"), Error);
  CHECK(qc({}, {}, 0.9, 3) == 0);
}
