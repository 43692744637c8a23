// Statistics of an episode from known positions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "study/identify/statistics/episode.h"

using namespace faba;

namespace {

const Episode kEpisode{"e", 0, {{0, 3, 0}, {3, 6, 180}}, {}};

CellView view() {
  CellView v;
  v.width = 320;
  v.height = 240;
  v.frame_s = 0.1;
  v.search_radius_px = 8;
  return v;
}

// Cells on a grid of 20 px that move right at 2 px per frame in the first segment, and back in the second.
std::vector<std::vector<Vec2>> seen_at(const std::vector<double>& times) {
  std::vector<std::vector<Vec2>> seen;
  for (const double t : times) {
    auto& one = seen.emplace_back();
    const double shift = 20 * (t < 3 ? t : 6 - t);
    for (int r = 0; r < 10; ++r)
      for (int c = 0; c < 5; ++c) one.push_back({40 + 20.0 * c + shift, 20 + 20.0 * r});
  }
  return seen;
}

double value_of(const EpisodeStatistics& s, const std::vector<double>& numbers, const std::string& what,
                std::size_t segment) {
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (s.numbers()[k].what == what && s.numbers()[k].segment == segment) return numbers[k];
  return std::nan("");
}

}  // namespace

TEST_CASE("episode statistics, tracks: velocities along and across both segments") {
  const auto s = make_statistics(Measure::tracks, kEpisode, view());
  const auto numbers = s->of_positions(seen_at(s->times_s()));
  REQUIRE(numbers.size() == s->numbers().size());
  for (const std::size_t segment : {0, 1}) {
    for (const char* what : {"10 % of speeds along", "median speed along", "90 % of speeds along"})
      CHECK(value_of(*s, numbers, what, segment) == doctest::Approx(2));
    CHECK(value_of(*s, numbers, "spread of speeds across", segment) == doctest::Approx(0));
    CHECK(value_of(*s, numbers, "median step", segment) == doctest::Approx(std::log(4.01)));
    CHECK(value_of(*s, numbers, "cells followed", segment) == doctest::Approx(std::log1p(50)));
  }
}

TEST_CASE("episode statistics, density: position of the swarm as a fraction of the view") {
  const auto s = make_statistics(Measure::density, kEpisode, view());
  const auto numbers = s->of_positions(seen_at(s->times_s()));
  REQUIRE(numbers.size() == s->numbers().size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto& n = s->numbers()[k];
    const double shift = 20 * (n.t_s < 3 ? n.t_s : 6 - n.t_s);
    // 1 % of the signal is distributed over the view, and the bins are one pixel wide.
    if (n.what == "median along") {
      const double middle = (80 + shift) / 321;
      CHECK(std::fabs(numbers[k] - (n.segment == 0 ? middle : 1 - middle)) < 3.0 / 321);
    }
    if (n.what == "cells in view") CHECK(numbers[k] == doctest::Approx(std::log(1.02)));
  }
  CHECK(numbers.back() == doctest::Approx(std::log1p(50)));
}

TEST_CASE("episode statistics: the change by a drift is that of shifted positions") {
  for (const Measure measure : {Measure::tracks, Measure::density}) {
    const auto s = make_statistics(measure, kEpisode, view());
    auto seen = seen_at(s->times_s());
    const auto before = s->of_positions(seen);
    const Vec2 drift{4, 0};  // px/s
    for (std::size_t k = 0; k < seen.size(); ++k)
      for (Vec2& at : seen[k]) at = at + s->times_s()[k] * drift;
    const auto after = s->of_positions(seen), change = s->of_drift(drift);
    REQUIRE(change.size() == before.size());
    for (std::size_t k = 0; k < change.size(); ++k)
      if (s->numbers()[k].what.find("along") != std::string::npos)
        CHECK(std::fabs(after[k] - before[k] - change[k]) < 0.01);  // bins of one pixel, 3 of 321
  }
}
