// The plant of estimators and controllers against swarms of single cells.
#include <doctest/doctest.h>

#include <cmath>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"
#include "control/plant/motion_model.h"

using namespace faba;

namespace {

constexpr double kRate = 60;  // Hz

Scenario scene(const std::string& model) {
  return read_scenario(parse_toml("duration = '100 s'\nseed = 3\ncamera = { rate = '60 Hz' }\narena = { type "
                                  "= 'box', size_px = [2000, 2000] }\n"
                                  "controller = 'manual'\nexclusion = { order = 'none' }\n[field]\ntype = "
                                  "'uniform'\n[[swarm]]\ncount = 3000\nmodel = " +
                                      model + "\nstart = { type = 'disc', radius_px = 20 }\n",
                                  "test"),
                       builtin_parts());
}

Vec2 centroid(const State& s) {
  const auto x = s.agents["x"], y = s.agents["y"];
  Vec2 sum;
  for (std::size_t i = 0; i < x.size(); ++i) sum = sum + Vec2{double(x[i]), double(y[i])};
  return (1 / double(x.size())) * sum;
}

/// The largest distance between the mean of the cells and the plant, relative to the path of the plant, for
/// fields that act one after the other, in field units along which the cells swim.
double largest_difference(const Scenario& s, const std::vector<std::pair<Vec2, double>>& fields) {
  Pool pool(1);
  Simulation simulation(s, *s.params.seed, pool);
  const ControlContext& c = simulation.control();
  CycleInput cycle;
  REQUIRE(begin_cycle(simulation.loop(), cycle));
  MeanState mean{centroid(simulation.world().state()), {}};
  double path = 0, largest = 0;
  for (const auto& [u, time] : fields)
    for (int k = 0; k < int(std::lround(time * kRate)); ++k) {
      const Command command = field_command(c, {}, u);
      end_cycle(simulation.loop(), cycle, command);
      const Vec2 before = mean.position;
      mean = advanced(c.motion, 1, mean, field_along(c, {}, command), c.frame_period);
      path += norm(mean.position - before);
      REQUIRE(begin_cycle(simulation.loop(), cycle));
      largest = std::max(largest, norm(centroid(simulation.world().state()) - mean.position));
    }
  MESSAGE("largest difference ", largest / path, " of a path of ", 1e6 * path, " um");
  return largest / path;
}

}  // namespace

TEST_CASE("motion: the plant of turning cells follows the mean of a swarm through turns") {
  const Scenario s = scene("{ type = 'dipole', preset = 'IT-1' }");
  // A difference of 3 % of the path is 0.5 um in a prediction over 5 frames, half a pixel of the camera; of
  // 10 %, in a weak field, where the spread of the moments counts, one and a half pixels.
  CHECK(largest_difference(s, {{{5, 0}, 1.5}}) < 0.03);                // aligned from rest
  CHECK(largest_difference(s, {{{5, 0}, 1}, {{0, 5}, 1}}) < 0.03);     // a quarter turn
  CHECK(largest_difference(s, {{{5, 0}, 1}, {{-5, 0}, 1.5}}) < 0.03);  // a reversal
  CHECK(largest_difference(s, {{{1, 0}, 1}, {{0, 1}, 1}}) < 0.1);
}

TEST_CASE("motion: the drift of the models of the thesis follows the field at once") {
  CHECK(largest_difference(scene("{ type = 'basic', max_speed = 0 }"), {{{3, 0}, 1}, {{0, -2}, 1}}) < 0.05);
  CHECK(largest_difference(scene("{ type = 'adapted', earth = 0, noise_amplitude = 0 }"),
                           {{{3, 0}, 1}, {{0, -2}, 1}}) < 0.05);
}

TEST_CASE("motion: rest, full alignment and the limit of fast turns") {
  const SwarmMotion m{.speed = 2e-4, .turning = 1e5, .diffusion = 0.5};
  // Without a field the mean velocity decays with the rotational diffusion.
  const MeanState decayed = advanced(m, 1, {{}, {1e-4, 0}}, {}, 1);
  CHECK(decayed.velocity.x == doctest::Approx(1e-4 * std::exp(-0.5)).epsilon(1e-3));
  // A strong field aligns: 1 - R = diffusion / (2 turning B) for large turning B, from the closure.
  MeanState s;
  for (int i = 0; i < 200; ++i) s = advanced(m, 1, s, {1e-3, 0}, 0.05);
  CHECK(s.velocity.x / 2e-4 == doctest::Approx(1 - 0.5 / (2 * 100)).epsilon(1e-3));
  CHECK(std::isfinite(norm(advanced(m, 1, s, {0, 10}, 1.0 / 60).velocity)));
}
