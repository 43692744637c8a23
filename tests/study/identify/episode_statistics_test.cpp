// What is measured of an episode, from positions that are known.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "study/identify/episode.h"

using namespace faba;

namespace {

const Episode kEpisode{"e", 0, {{0, 3, 0}, {3, 6, 180}}, {}};

CellView view() {
  CellView v;
  v.width = 320;
  v.height = 240;
  v.frame_s = 0.1;
  v.reach_px = 8;
  return v;
}

// Cells in rows 20 px apart that go right at 2 px per frame in the first segment, and back in the second.
std::vector<std::vector<Vec2>> seen_at(const std::vector<double>& times) {
  std::vector<std::vector<Vec2>> seen;
  for (const double t : times) {
    auto& one = seen.emplace_back();
    const double gone = 20 * (t < 3 ? t : 6 - t);
    for (int r = 0; r < 10; ++r)
      for (int c = 0; c < 5; ++c) one.push_back({40 + 20.0 * c + gone, 20 + 20.0 * r});
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

TEST_CASE("tracks: speeds along and across are those of the cells, in both directions") {
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

TEST_CASE("density: the swarm's place is that of its cells, as a share of the view") {
  const auto s = make_statistics(Measure::density, kEpisode, view());
  const auto numbers = s->of_positions(seen_at(s->times_s()));
  REQUIRE(numbers.size() == s->numbers().size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto& n = s->numbers()[k];
    const double gone = 20 * (n.t_s < 3 ? n.t_s : 6 - n.t_s);
    // One in a hundred is spread over the view, and places are told to the bin, a pixel.
    if (n.what == "median along") {
      const double middle = (80 + gone) / 321;
      CHECK(std::fabs(numbers[k] - (n.segment == 0 ? middle : 1 - middle)) < 3.0 / 321);
    }
    if (n.what == "cells in view") CHECK(numbers[k] == doctest::Approx(std::log(1.02)));
  }
  CHECK(numbers.back() == doctest::Approx(std::log1p(50)));
}
