#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"

namespace faba {

/// A simulation of a scenario given as TOML text, for tests that step the world.
struct TestSwarm {
  Pool pool;
  Scenario scenario;
  Simulation simulation;

  explicit TestSwarm(const std::string& toml, std::uint64_t seed = 1, unsigned threads = 1)
      : pool(threads),
        scenario(read_scenario(parse_toml(toml, "test"), builtin_parts())),
        simulation(scenario, seed, pool) {}
  World& world() { return simulation.world(); }
  std::span<const float> column(const char* name) { return simulation.world().state().agents[name]; }

  /// Modifies the state with `change(State&)`.
  template <class Change>
  void alter(Change&& change) {
    State s = world().state();
    change(s);
    world().restore(std::move(s));
  }
};

/// Mean and standard error of the mean of n values value(0), ..., value(n-1).
struct Sample {
  double mean = 0, variance = 0, standard_error = 0;
  template <class Value>
  static Sample of(std::size_t n, Value&& value) {
    Sample s;
    for (std::size_t i = 0; i < n; ++i) s.mean += double(value(i)) / double(n);
    for (std::size_t i = 0; i < n; ++i)
      s.variance += (double(value(i)) - s.mean) * (double(value(i)) - s.mean);
    s.variance /= double(n - 1);
    s.standard_error = std::sqrt(s.variance / double(n));
    return s;
  }
};

/// A scenario without walls and exclusion, with a uniform field of 1 T/A, so that currents in A equal fields
/// in T. Cells are north-seeking and start at the origin. `model` is the content of the inline table of the
/// model; one frame is one step of `dt` s.
inline std::string free_space(const std::string& model, double dt, int count) {
  return fmt::format(
      "duration = 1\nexclusion = {{ order = 'none' }}\narena = {{ type = 'box', size_px = [65536, 65536] }}\n"
      "field = {{ type = 'uniform', gain = 1 }}\ncamera = {{ rate = {} }}\nsimulation = {{ step = {} }}\n"
      "[[swarm]]\ncount = {}\npolarity = 'north'\nstart = {{ type = 'disc', radius_px = 0 }}\nmodel = {{ {} "
      "}}\n",
      1 / dt, dt, count, model);
}

}  // namespace faba
