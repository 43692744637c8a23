// U-turns of simulated dipoles: the law without noise, its bias with noise, cells of both polarities, and
// cells that do not turn.
#include "study/uturn/u_turns.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "study/uturn/moment.h"
#include "study/uturn/moment_warnings.h"
#include "study/uturn/simulated_turns.h"

using namespace faba;

namespace {

double rate_in(const UTurnSurvey& s) {
  std::vector<double> times;
  for (const UTurn& t : s.turns) times.push_back(t.time_s);
  return 1 / median(times);
}

MomentEstimate estimate(const std::vector<Track>& tracks, double frame_s, double field_t) {
  FieldStrength f{.file = "turns.avi",
                  .field_t = field_t,
                  .survey = find_u_turns(tracks, {kSimulatedReversal_s}, frame_s)};
  return moment_of({f}, CellBody{.length = 1.4e-6, .width = 1.4e-6, .drag_sd = 0.1}, 0);
}

bool warns(const MomentEstimate& m, const std::string& aspect) {
  return std::any_of(m.warnings.begin(), m.warnings.end(),
                     [&](const Warning& w) { return w.aspect == aspect; });
}

constexpr double kRate = 10, kFrame = 0.02;  // 1/s, s

}  // namespace

TEST_CASE("with little noise the law of a dipole gives the rate of a turn") {
  // The headings must differ from the unstable direction: kappa = 1e4. The scatter of a turn is 1 /
  // sqrt(kappa).
  const UTurnSurvey s =
      find_u_turns(simulated_u_turns(kRate, 1e-4, 0, kFrame, 3, 40, 3), {kSimulatedReversal_s}, kFrame);
  CHECK(s.turns.size() == 40);
  const double dt = kRate * kFrame;
  // Frames: (w dt)^2 / 36 and as much for the ends; 40 turns: 1.25 / sqrt(40 kappa); 4 standard errors.
  CHECK(rate_in(s) == doctest::Approx(kRate).epsilon(dt * dt / 18 + 4 * 1.25 / std::sqrt(40 * 1e4)));
  CHECK(*s.turn_speed == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("with thermal noise the corrected rate is true within its standard error, in pixels of any size") {
  constexpr double kKappa = 12;
  constexpr std::size_t kCells = 400;
  std::vector<Track> tracks = simulated_u_turns(kRate, 1 / kKappa, 1e-3, kFrame, 2, kCells, 5);
  // Rotated, magnified, and half of the cells swim against the field: other headings, the same turns.
  for (Track& t : tracks)
    for (TrackPoint& p : t.points) {
      const double sign = t.number % 2 ? 7 : -7, x = p.x_px, y = p.y_px;
      p.x_px = sign * (0.6 * x - 0.8 * y);
      p.y_px = sign * (0.8 * x + 0.6 * y);
    }
  const MomentEstimate m = estimate(tracks, kFrame, 1e-4);
  // A turn scatters by 1 / sqrt(kappa); the median of n by 1.25 / sqrt(n) of it; 4 standard errors.
  CHECK(m.turns > 0.85 * kCells);
  CHECK(m.rate_per_t->median ==
        doctest::Approx(kRate / 1e-4).epsilon(4 * 1.25 / std::sqrt(kKappa * double(m.turns))));
  CHECK(m.rate_per_t->ci90[0] < m.rate_per_t->median);
  CHECK(m.moment->median == doctest::Approx(m.rate_per_t->median * *m.drag).epsilon(1e-9));
  // The uncertainty of the drag is part of the interval of the moment: 1.645 * 0.1 on each side.
  CHECK(std::log(m.moment->ci90[1] / m.moment->median) > 0.13);
  CHECK(quality_of(m.warnings) == Quality::good);
  CHECK(m.fields[0].bias > 1);  // the median of single turns is biased by noise
}

TEST_CASE("warnings: few frames per turn, weak field, turns out of the plane, no turns") {
  CHECK(warns(estimate(simulated_u_turns(kRate, 0.05, 0, 0.08, 3, 100, 1), 0.08, 1e-4), "frame rate"));
  CHECK(warns(estimate(simulated_u_turns(kRate, 0.3, 0, kFrame, 3, 100, 1), kFrame, 1e-4), "field"));
  std::vector<Track> tilted = simulated_u_turns(kRate, 0.05, 0, kFrame, 3, 100, 1);
  for (Track& t : tilted)
    for (TrackPoint& p : t.points) p.y_px *= std::cos(double(t.number % 9) / 9 * 3.14159);
  const MomentEstimate m = estimate(tilted, kFrame, 1e-4);
  CHECK(warns(m, "tilt"));
  CHECK(quality_of(m.warnings) == Quality::poor);
  const FieldStrength none{.file = "still.avi", .field_t = 1e-4, .survey = find_u_turns({}, {1.0}, kFrame)};
  const MomentEstimate empty = moment_of({none}, {}, 0);
  CHECK(!empty.rate_per_t);
  CHECK(quality_of(empty.warnings) == Quality::poor);
}
