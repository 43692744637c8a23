// Lines against exposure (theory A16): coverage of the confidence intervals for experiments that differ.
#include "study/stats/exposure_lines.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace faba;

namespace {

std::vector<ExposureValue> made(unsigned seed, double shift_sd, int experiments = 4, int exposures = 7,
                                double growth = 0) {
  std::mt19937 g(seed);
  std::normal_distribution<double> gauss;
  std::vector<ExposureValue> out;
  for (int e = 0; e < experiments; ++e) {
    const double shift = shift_sd * gauss(g);
    for (int i = 0; i < exposures; ++i)
      out.push_back(
          {100.0 * i, 0.0052 * 100 * i + 1 + shift + 0.1 * (1 + growth * i) * gauss(g), std::to_string(e)});
  }
  return out;
}

}  // namespace

TEST_CASE("95 % intervals of slope and intercept have their nominal coverage, with and without shifts") {
  for (const double shift : {0.0, 0.5}) {
    int slope = 0, intercept = 0, pooled = 0;
    const int n = 400;
    for (unsigned seed = 1; seed <= n; ++seed) {
      const auto values = made(seed, shift);
      const auto line = mixed_line(values), all = pooled_line(values);
      REQUIRE(line);
      slope += line->slope_ci95[0] <= 0.0052 && 0.0052 <= line->slope_ci95[1];
      intercept += line->intercept_ci95[0] <= 1 && 1 <= line->intercept_ci95[1];
      pooled += all->intercept_ci95[0] <= 1 && 1 <= all->intercept_ci95[1];
    }
    // Binomial: 380 of 400 expected, standard deviation 4.4; tolerance of four.
    CHECK(slope > 362);
    CHECK(intercept > 362);
    if (shift > 0) CHECK(pooled < 350);  // values of one experiment are correlated
  }
}

TEST_CASE("intervals keep their coverage when late values scatter more than early ones") {
  int mixed = 0, pooled = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const auto values = made(seed, 0.2, 4, 7, 1.5);
    const auto line = mixed_line(values), all = pooled_line(values);
    mixed += line->slope_ci95[0] <= 0.0052 && 0.0052 <= line->slope_ci95[1];
    pooled += all->slope_ci95[0] <= 0.0052 && 0.0052 <= all->slope_ci95[1];
  }
  CHECK(mixed > 362);
  CHECK(pooled < mixed);
}

TEST_CASE("experiments without shifts and a single experiment give the pooled line") {
  const auto one = made(3, 0, 1);
  CHECK(mixed_line(one)->slope == doctest::Approx(pooled_line(one)->slope).epsilon(1e-12));
  CHECK_FALSE(mixed_line(std::vector<ExposureValue>{{0, 1, "a"}, {0, 2, "b"}, {0, 3, "c"}}));
  CHECK_FALSE(pooled_line(std::vector<ExposureValue>{{0, 1, "a"}, {1, 2, "b"}}));
  const auto shifted = made(5, 2);
  const auto line = mixed_line(shifted);
  CHECK(line->experiments == 4);
  CHECK(line->values == 28);
  CHECK(line->experiment_sd > 0.5);
  CHECK(line->scatter_sd == doctest::Approx(0.1).epsilon(0.5));
}

TEST_CASE("the cut-off is between the exposures that it separates") {
  std::vector<ExposureResponse> samples;
  for (int e = 0; e < 4; ++e)
    for (int i = 1; i <= 8; ++i) samples.push_back({100.0 * i, i <= 6});
  auto cut = response_cutoff(samples);
  REQUIRE(cut);
  CHECK(cut->cutoff_s == 650);
  CHECK(cut->wrong == 0);
  samples[7].responds = true;  // one outlier at 800 s
  cut = response_cutoff(samples);
  REQUIRE(cut);
  CHECK(cut->cutoff_s == 650);
  CHECK(cut->wrong == 1);
  for (auto& s : samples) s.responds = true;
  CHECK_FALSE(response_cutoff(samples));
  for (auto& s : samples) s.responds = false;
  CHECK_FALSE(response_cutoff(samples));
  CHECK_FALSE(response_cutoff({}));
}
