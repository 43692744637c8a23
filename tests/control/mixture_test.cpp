// Two swarms at once: both setpoints where the coils make different fields at them, and the conserved
// combination of their positions in a uniform field (theory F1).
#include <doctest/doctest.h>

#include <array>

#include "app/run/notes.h"
#include "tests/swarm.h"

using namespace faba;

namespace {

const std::string kRigs = std::string(FABA_SCENES) + "/../rigs/";
const std::string kEight = "{ type = 'rig', file = '" + kRigs + "eight-coils.toml' }";
const std::string kFour = "{ type = 'rig', file = '" + kRigs + "thesis-four-coils.toml' }";

struct Setup {
  std::string field = "'uniform'";
  std::string second_polarity = "south";
  std::string controller;  ///< other keys
  std::string second = "[380, 300]";
  std::string setpoint = "[250, 230]";
  std::string second_model = "preset = 'IT-1'";
  std::string estimator = "{ type = 'groups', count = 2 }";
};
std::string scene(const Setup& s) {
  const std::string swarm =
      "[[swarm]]\ncount = 100\npolarity = '{}'\nmodel = {{ type = 'dipole', {} }}\n"
      "start = {{ type = 'disc', centre_px = {}, radius_px = 12 }}\n";
  return fmt::format(
             "duration = 60\narena = {{ type = 'drop', radius_px = 500 }}\ncamera = {{ rate = 60 }}\n"
             "field = {}\nestimator = {}\n"
             "[controller]\ntype = 'mixture'\nnear_px = [240, 180]\n{}\n"
             "[reference]\ntype = 'hold'\nsetpoint_px = {}\n",
             s.field, s.estimator, s.controller, s.setpoint) +
         fmt::format(fmt::runtime(swarm), "north", "preset = 'IT-1'", "[240, 180]") +
         fmt::format(fmt::runtime(swarm), s.second_polarity, s.second_model, s.second);
}

using Pair = std::array<Vec2, 2>;
/// Means of both swarms, px.
Pair means_px(TestSwarm& t) {
  const auto x = t.column("x"), y = t.column("y");
  const std::vector<Population>& swarms = t.world().parts().populations;
  Pair means;
  for (std::size_t s = 0; s < 2; ++s) {
    Vec2 sum;
    for (std::size_t i = swarms[s].begin; i < swarms[s].end; ++i)
      sum = sum + Vec2{double(x[i]), double(y[i])};
    means[s] = t.simulation.frame().image_from_world((1 / double(swarms[s].end - swarms[s].begin)) * sum);
  }
  return means;
}
/// Means after `frames` frames, over the last `averaged` of them.
Pair after(TestSwarm& t, int frames, int averaged) {
  Pair sum;
  for (int k = 0; k < frames; ++k) {
    REQUIRE(run_cycle(t.simulation.loop()));
    if (k < frames - averaged) continue;
    const Pair now = means_px(t);
    for (std::size_t s = 0; s < 2; ++s) sum[s] = sum[s] + (1.0 / averaged) * now[s];
  }
  return sum;
}
std::string notes(const Setup& s) {
  TestSwarm t(scene(s));
  std::string all;
  for (const std::string& n : scenario_notes(t.scenario, t.simulation, "/tmp")) all += n + "\n";
  return all;
}

}  // namespace

TEST_CASE("mixture: two swarms of opposite polarity reach their two setpoints between eight coils") {
  int reached = 0;
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    TestSwarm t(scene({.field = kEight, .controller = "second_px = [400, 240]"}), seed);
    const Pair end = after(t, 60 * 30, 64);
    const double first = norm(end[0] - Vec2{250, 230}), second = norm(end[1] - Vec2{400, 240});
    MESSAGE("seed ", seed, ": ", first, " px, ", second, " px");
    if (first < 5 && second < 5) ++reached;
    worst = std::max({worst, first, second});
  }
  MESSAGE(reached, " of 10 reach both setpoints within 5 px; largest distance ", worst, " px");
  CHECK(reached >= 9);
}
