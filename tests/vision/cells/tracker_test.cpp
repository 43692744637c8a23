#include "vision/cells/tracker.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "core/error.h"
#include "tests/vision/rendered_cells.h"
#include "vision/cells/assignment.h"

using namespace faba;

namespace {

Spot spot(Vec2 p, double mass = 100) {
  Spot s;
  s.x_px = p.x;
  s.y_px = p.y;
  s.sd_px = 0.05;
  s.mass = mass;
  s.snr = 20;
  return s;
}

std::vector<Track> track_all(Tracker& t, const std::vector<std::vector<Spot>>& frames, double frame_s = 0.1) {
  for (std::size_t k = 0; k < frames.size(); ++k) t.take(k, double(k) * frame_s, frames[k]);
  t.finish();
  return t.finished();
}

// Maximum sum of gains by exhaustive search.
double best_exhaustive(int row, int rows, std::vector<bool>& used, const std::vector<PossiblePair>& all) {
  if (row == rows) return 0;
  double best = best_exhaustive(row + 1, rows, used, all);
  for (const PossiblePair& c : all)
    if (c.row == row && !used[std::size_t(c.column)]) {
      used[std::size_t(c.column)] = true;
      best = std::max(best, c.gain + best_exhaustive(row + 1, rows, used, all));
      used[std::size_t(c.column)] = false;
    }
  return best;
}

}  // namespace

TEST_CASE("the assignment is optimal") {
  cells::Dice dice(3);
  for (int trial = 0; trial < 200; ++trial) {
    const int rows = 1 + int(dice.uniform() * 6), columns = 1 + int(dice.uniform() * 6);
    std::vector<PossiblePair> all;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        if (dice.uniform() < 0.6) all.push_back({r, c, 0.01 + 10 * dice.uniform()});
    const std::vector<int> of_row = best_assignment(rows, columns, all);
    double sum = 0;
    std::vector<int> taken(std::size_t(columns), 0);
    for (int r = 0; r < rows; ++r)
      for (const PossiblePair& c : all)
        if (c.row == r && of_row[std::size_t(r)] == c.column) {
          sum += c.gain;
          ++taken[std::size_t(c.column)];
        }
    for (const int n : taken) CHECK(n <= 1);
    std::vector<bool> used(std::size_t(columns), false);
    CHECK(sum ==
          doctest::Approx(best_exhaustive(0, rows, used, all)).epsilon(1e-5));  // gains are rounded to 2^-20
  }
}

TEST_CASE("crossing cells keep their tracks") {
  std::vector<std::vector<Spot>> frames;
  cells::Dice dice(1);
  for (int k = 0; k < 40; ++k) {
    const auto noisy = [&](double x, double y) {
      return spot({x + 0.1 * dice.normal(), y + 0.1 * dice.normal()});
    };
    frames.push_back({noisy(20 + 3.0 * k, 40 + 2.0 * k), noisy(137 - 3.0 * k, 41 + 2.0 * k)});
  }
  TrackerOptions o;
  o.motion = Motion::velocity;
  o.search_radius_px = 8;
  Tracker t(o);
  const auto tracks = track_all(t, frames);
  REQUIRE(tracks.size() == 2);
  for (const Track& track : tracks) {
    REQUIRE(track.points.size() == 40);
    const double went = track.points.back().x_px - track.points.front().x_px;
    CHECK(std::fabs(std::fabs(went) - 117) < 1);
  }
}

TEST_CASE("a cell keeps its track after a short gap and starts a new one after a long gap") {
  for (const int gap : {1, 2, 3}) {
    std::vector<std::vector<Spot>> frames;
    for (int k = 0; k < 30; ++k) {
      std::vector<Spot> s{spot({10 + 4.0 * k, 50}), spot({200 - 4.0 * k, 90})};
      if (k >= 15 && k < 15 + gap) s.erase(s.begin());
      frames.push_back(s);
    }
    TrackerOptions o;
    o.max_gap_frames = 2;
    Tracker t(o);
    const auto tracks = track_all(t, frames);
    CHECK(tracks.size() == (gap <= 2 ? 2u : 3u));
    for (const Track& track : tracks)
      for (std::size_t i = 1; i < track.points.size();
           ++i)  // frames without detection are missing in the track
        CHECK(track.points[i].t_s - track.points[i - 1].t_s ==
              doctest::Approx(0.1 * double(track.points[i].frame - track.points[i - 1].frame)));
  }
}

TEST_CASE("tracks start and end with their cells; single spots are not tracks") {
  std::vector<std::vector<Spot>> frames;
  cells::Dice dice(4);
  for (int k = 0; k < 40; ++k) {
    std::vector<Spot> s;
    if (k >= 5 && k < 30) s.push_back(spot({50 + 2.0 * k, 60}));
    if (k >= 20) s.push_back(spot({200, 100 + 1.5 * k}));
    if (k % 7 == 0) s.push_back(spot({300 * dice.uniform(), 230 * dice.uniform()}));
    frames.push_back(s);
  }
  TrackerOptions o;
  o.search_radius_px = 6;
  Tracker t(o);
  const auto tracks = track_all(t, frames);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].points.front().frame == 5);
  CHECK(tracks[0].points.back().frame == 29);
  CHECK(tracks[1].points.front().frame == 20);
  CHECK(t.discarded_tracks() >= 4);
}

TEST_CASE("a thousand swimmers: nearly all links are correct; reach and motion model are estimated") {
  // Density 0.0033 per px^2: mean nearest-neighbour distance 8.7 px; half of it is 4.4 px per frame.
  cells::Look l;
  l.width = 640;
  l.height = 480;
  cells::Dice dice(9);
  std::vector<Vec2> at, v;
  for (int i = 0; i < 1000; ++i) {
    at.push_back({640 * dice.uniform(), 480 * dice.uniform()});
    const double angle = 6.283185 * dice.uniform();
    v.push_back({4 * std::cos(angle), 4 * std::sin(angle)});
  }
  std::vector<std::vector<Spot>> frames;
  for (int k = 0; k < 30; ++k) {
    std::vector<Spot> s;
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = at[i] + v[i] + Vec2{0.1 * dice.normal(), 0.1 * dice.normal()};
      if (at[i].x < 0 || at[i].x > 639 || at[i].y < 0 || at[i].y > 479 || dice.uniform() < 0.02) continue;
      s.push_back(spot(at[i], double(i)));  // the mass identifies the cell
    }
    frames.push_back(s);
  }
  Tracker t;
  const auto tracks = track_all(t, frames);
  CHECK(t.motion() == Motion::velocity);
  CHECK(t.search_radius_px() > 4);
  CHECK(t.search_radius_px() < 14);
  int right = 0, wrong = 0;
  double length = 0;
  for (const Track& track : tracks)
    for (std::size_t i = 1; i < track.points.size(); ++i) {
      (track.points[i].mass == track.points[i - 1].mass ? right : wrong) += 1;
      length += std::hypot(track.points[i].x_px - track.points[i - 1].x_px,
                           track.points[i].y_px - track.points[i - 1].y_px) /
                double(track.points[i].frame - track.points[i - 1].frame);
    }
  CHECK(wrong < 0.02 * right);
  CHECK(right > 20000);
  CHECK(length / (right + wrong) == doctest::Approx(4).epsilon(0.03));
}

TEST_CASE("diffusing particles are tracked with the nearest model") {
  cells::Dice dice(2);
  std::vector<Vec2> at;
  for (int i = 0; i < 200; ++i) at.push_back({400 * dice.uniform(), 300 * dice.uniform()});
  std::vector<std::vector<Spot>> frames;
  for (int k = 0; k < 40; ++k) {
    std::vector<Spot> s;
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = at[i] + Vec2{dice.normal(), dice.normal()};
      s.push_back(spot(at[i], double(i)));
    }
    frames.push_back(s);
  }
  Tracker t;
  const auto tracks = track_all(t, frames);
  CHECK(t.motion() == Motion::nearest);
  int wrong = 0, all = 0;
  for (const Track& track : tracks)
    for (std::size_t i = 1; i < track.points.size(); ++i, ++all)
      wrong += track.points[i].mass != track.points[i - 1].mass;
  CHECK(wrong < 0.02 * all);
}

TEST_CASE("uneven frame spacing: velocities are per second, not per frame") {
  TrackerOptions o;
  o.motion = Motion::velocity;
  o.search_radius_px = 6;
  Tracker t(o);
  double time = 0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    time += k % 3 == 0 ? 0.2 : 0.05;
    t.take(k, time, {spot({20 + 30 * time, 50}), spot({20 + 30 * time, 58})});
  }
  t.finish();
  CHECK(t.finished().size() == 2);
}

TEST_CASE("long tracks are returned in pieces; time must increase") {
  TrackerOptions o;
  o.max_points = 100;
  Tracker t(o);
  std::size_t points = 0, pieces = 0;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    t.take(k, double(k), {spot({50, 50})});
    for (const Track& piece : t.finished()) {
      CHECK(piece.number == 1);
      CHECK(piece.continues);
      points += piece.points.size();
      ++pieces;
    }
  }
  t.finish();
  for (const Track& piece : t.finished()) points += piece.points.size();
  CHECK(points == 1000);
  CHECK(pieces >= 9);
  Tracker again;
  again.take(0, 1, {});
  CHECK_THROWS_AS(again.take(1, 1, {}), Error);
  Tracker empty;
  empty.finish();
  CHECK(empty.finished().empty());
}
